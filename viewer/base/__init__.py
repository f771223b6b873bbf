"""Parts that all packages of the viewer use: theme, files, pictures, progress, options, wording, the orbit camera."""
