"""Visible surfaces of a scene as outlines, for the scene figure."""
