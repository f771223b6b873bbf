"""The report: an image's error against the time it takes, as a page, plots and data."""
