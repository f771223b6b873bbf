"""`raytree report`: error against run time, for each source of error."""
