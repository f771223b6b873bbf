"""The state of the program: scene on show, picked pixel, selected ray, image in progress. No GPU, no panel."""
