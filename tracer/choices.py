"""Names that scene files, the command line and kernels choose by. Imports nothing, so that `--help` stays fast."""

MODELS = ("whitted", "fresnel")  # of the weights of reflected and refracted rays
WHITTED, FRESNEL = range(2)

SHADOWS = ("filter", "block")  # what glass does to shadow rays
FILTER, BLOCK = range(2)

SAMPLERS = ("sobol", "random", "jittered")  # where in a pixel its samples lie
SOBOL, RANDOM, JITTERED = range(3)
