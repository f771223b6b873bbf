"""The panel of a lesson: its text, its live pieces, source text, and the task that it sets."""
