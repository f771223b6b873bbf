"""Tests of the tools of the benchmarks, never of speed."""
