"""What brings a view back: its state, the files of its scene, and how figures carry both."""
