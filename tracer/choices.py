"""Names that scene files, the command line and kernels choose by. Imports nothing, so that `--help` stays fast."""

MODELS = ("whitted", "fresnel")  # models for the weights of reflected and refracted rays
WHITTED, FRESNEL = range(2)

SHADOWS = ("filter", "block")  # effect of transparent surfaces on shadow rays
FILTER, BLOCK = range(2)

SAMPLERS = ("sobol", "random", "jittered")  # placement of the samples in a pixel
SOBOL, RANDOM, JITTERED = range(3)

SYMBOLS = {"camera": "E", "reflection": "R", "refraction": "T", "tir": "TIR", "shadow": "L"}  # kinds of rays in labels
