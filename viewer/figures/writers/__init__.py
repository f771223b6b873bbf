"""Writers: marks to SVG, PDF, PNG, TikZ, PPTX; the node table to CSV and DOT."""
