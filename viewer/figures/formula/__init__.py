"""Formulas, typeset: their outlines, from `viewer.explain.formulas` or any other source."""
