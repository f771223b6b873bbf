"""Lessons: reading `lesson.md`."""
