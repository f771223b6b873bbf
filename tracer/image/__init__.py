"""The image: tiles on a thread pool or a cluster, passes, adaptive sampling."""
