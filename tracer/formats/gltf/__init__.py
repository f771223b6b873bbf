"""glTF 2.0: `reader` reads a file, the other modules its parts."""
