"""The families of `raytree check`: many random draws of one problem, from a fixed seed."""
