"""What is said of a ray, as sections of formulas and numbers, for panels and figures to lay out."""
