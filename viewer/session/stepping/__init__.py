"""Steps of the tree on show: revealing it, and the recursion beside it."""
