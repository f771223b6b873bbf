"""Visible surfaces of a scene as outlines, for the figure of the scene."""
