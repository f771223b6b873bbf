"""A view is brought back: its state in the session, the scene of a figure, the last session, its command line."""
