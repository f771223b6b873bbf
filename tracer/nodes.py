"""The node table as a public module: see `tracer.kernel.nodes`, where the code lives."""

from tracer.kernel.nodes import *  # noqa: F403
