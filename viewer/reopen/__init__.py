"""Reopening a view: its state, the files of its scene, and how figures carry both."""
