"""Measures the tracer: how good its numbers are. Everything here goes through scenes and the kernel of the image."""
