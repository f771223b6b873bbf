"""Formulas, typeset: their outlines, from `viewer.explain.formulas` or any other source."""

UNITS = 1000  # of the paths of outlines, in an em
