"""The explanation of a ray: sections of formulas and numbers, which panels and figures lay out."""
