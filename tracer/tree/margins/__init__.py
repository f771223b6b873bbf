"""Decision margins: how far, in units of its own rounding error, each ray was from going otherwise."""
