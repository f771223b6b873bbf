"""The figures: each a function to marks."""
