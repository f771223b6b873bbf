"""The verified tree: guaranteed enclosures of a recorded tree's points, weights and colours, by ball arithmetic."""
