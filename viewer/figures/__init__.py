"""Figures of ray trees: marks on a canvas, laid out here and written to files in several formats."""
