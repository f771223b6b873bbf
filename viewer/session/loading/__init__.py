"""Opening scenes: what to open, loading it in the background, and following its files."""
