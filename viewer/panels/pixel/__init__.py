"""The picked pixel in the image panel: its colours, the choice of a sample, and the points of its samples."""
