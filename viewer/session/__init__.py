"""The state of the viewer, without GPU and panels."""
