"""Parts that all rooms of the viewer use: theme, files, pictures, progress, options, wording, the orbit camera."""
