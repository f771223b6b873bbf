"""The only package that imports Numba: compiling and caching kernels, SIMD vectors, intrinsics, bundles of arrays."""
