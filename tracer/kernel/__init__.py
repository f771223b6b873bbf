"""The kernel: one pixel's ray tree, from the arrays of a prepared scene to the rows of the node table."""
