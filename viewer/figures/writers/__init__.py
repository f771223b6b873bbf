"""Writers: marks to SVG, PDF, PNG, TikZ, PPTX, HTML; the node table to CSV and DOT."""
