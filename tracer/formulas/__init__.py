"""The lecture's formulas, under the lecture's names: optics, shading, media, camera, samples, vectors.

Plain Python that Numba compiles when a kernel calls it.
"""
