"""The node table as a public module: see `tracer.kernel.nodes`, where the code lives."""

from tracer.kernel.nodes import ENDS, KINDS, NODE, PUBLIC

__all__ = ["ENDS", "KINDS", "NODE", "PUBLIC"]
