"""`raytree check`: cases with exact answers, compared with the textbook's formulas and with ours."""
