"""Giving a lesson: going from moment to moment with two keys."""
