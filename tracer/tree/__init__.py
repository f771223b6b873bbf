"""The recorded ray tree: queries, text and JSON, bounds on what was cut, propagation of rounding errors."""
