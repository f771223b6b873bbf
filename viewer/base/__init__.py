"""Shared by all rooms of the viewer: theme, files, pictures, progress, interruption, wording, the orbiting eye."""
