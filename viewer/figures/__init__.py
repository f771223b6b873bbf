"""The ray tree for other programs: one small writer a format, all from the same record."""
