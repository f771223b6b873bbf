"""The only room that knows Numba: compilation and caching of kernels, SIMD vectors, intrinsics, bundles of arrays."""
