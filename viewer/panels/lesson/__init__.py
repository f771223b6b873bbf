"""The panel of a lesson: its text, the handle of a sweep, and live pieces."""
