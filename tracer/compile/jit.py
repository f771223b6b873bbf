"""Decorators that compile plain Python with Numba.

`kernel` marks an entry point: it is compiled at its first call, runs without the GIL, and is cached on disk.
`inlined` and `compiled` mark functions that kernels call. Called from Python they remain plain functions, so each
formula exists once, can be tested by itself, and can be stepped through with NUMBA_DISABLE_JIT=1.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numba
from numba.extending import register_jitable

from tracer.compile.kernel_cache import cache_folder
from tracer.compile.numba_private import IR_ONLY, NO_RUNTIME, is_stored, use_cache_folder

P = ParamSpec("P")
R = TypeVar("R")

OPTIONS = {
    "nogil": True,  # tiles are traced by several threads at once
    "error_model": "numpy",  # x/0 is inf, as in IEEE 754, and costs no branch
    **NO_RUNTIME,
}


def inlined(function: Callable[P, R]) -> Callable[P, R]:
    """Mark a function that kernels call and that is always inlined into its caller."""
    return register_jitable(forceinline=True, **OPTIONS, **IR_ONLY)(function)


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Mark a function that kernels call; the optimiser decides whether to inline it."""
    return register_jitable(forceinline=False, **OPTIONS, **IR_ONLY)(function)


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Mark an entry point: compiled at its first call with these types, later loaded from `cache_folder`."""
    entry: Any = numba.njit(**OPTIONS)(function)
    cache_in(entry, cache_folder())
    return entry


def cache_in(entry: Any, folder: Path | None) -> None:
    """Load and store an entry point's machine code in this folder; None: nowhere."""
    if folder is not None and not is_uncompiled(entry):
        use_cache_folder(entry, folder)


def is_compiled(entry: Any) -> bool:
    """Whether this process has machine code of an entry point. True where compilation is switched off."""
    return bool(getattr(entry, "signatures", True))


def is_cached(entry: Any) -> bool:
    """Whether machine code of an entry point is on disk, undamaged."""
    folder = cache_folder()
    return folder is not None and not is_uncompiled(entry) and is_stored(entry, folder)


def is_uncompiled(entry: Any) -> bool:
    """Whether an entry point runs as plain Python, since compilation is switched off."""
    return not hasattr(entry, "py_func")
