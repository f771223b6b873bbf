"""The bounding volume hierarchy (BVH): its construction by the surface area heuristic, and its traversal."""
