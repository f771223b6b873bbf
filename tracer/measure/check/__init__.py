"""`raytree check`: cases with exact answers, beside the textbook's formulas."""
