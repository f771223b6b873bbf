"""A render that is interrupted ends its threads, whenever that happens."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import tracer
from tracer.choices import SAMPLERS, SOBOL
from tracer.formulas.sampler import make_sampler
from tracer.image.passes import trace_passes
from tracer.image.task import Task, Work
from tracer.image.tiles import make_passes
from tracer.kernel.limits import make_limits

ENDLESS = 10**9  # samples of a pixel: they would take minutes


class InterruptedPool(ThreadPoolExecutor):
    """Threads whose user is interrupted when the first call has begun, before it is noted anywhere."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        super().submit(fn, *args, **kwargs)
        raise KeyboardInterrupt


def test_a_call_that_is_not_noted_yet_ends_as_well(worlds: dict[str, tracer.World]) -> None:
    """The pool waits for its thread, so this ends only if the call does."""
    world, size = worlds["glass-ball"], (2, 2)
    task = Task.of(world, world.view(size), make_limits(world, records=False), make_sampler(SAMPLERS[SOBOL], ENDLESS))
    passes = [[Work(tile, 0, ENDLESS) for tile in tiles] for tiles in make_passes(*size, (1,))]
    with pytest.raises(KeyboardInterrupt), InterruptedPool(1) as pool:
        trace_passes(task, passes, pool, 1, lambda traced, share: None, np.zeros((2, 2, 3)))
