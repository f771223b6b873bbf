"""Measures the tracer: errors, exact cases, and what each capability costs. Everything is traced by the kernel of the
image.
"""
