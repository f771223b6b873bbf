"""Layout: the tidy tree, placement of boxes and labels, folding of branches."""
