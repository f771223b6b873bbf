"""The live pieces, one file each. `viewer.lessons.live.catalogue` lists them."""
