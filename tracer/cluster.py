"""Rendering on a Dask cluster as a public module: see `tracer.image.cluster`, where the code lives."""

from tracer.image.cluster import Cluster, ClusterError, connect

__all__ = ["Cluster", "ClusterError", "connect"]
