"""Measured figures: their spread and targets, and reports of them as a table, JSON and bars."""
