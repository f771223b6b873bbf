"""How kernels are compiled and where the machine code is kept.

`compiled` marks a formula: plain Python when a person calls it, machine code when a kernel does, so there is one
source of the physics. `kernel` marks an entry point: compiled as a whole, run without the interpreter's lock,
and kept on disk. Its folder is named by a hash of every source of this package, because Numba itself notices
a change in the entry point's own file only and would go on using stale code of the files it calls.
"""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numba
import platformdirs
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import cpu_target
from numba.core.runtime.nrt import rtsys
from numba.extending import register_jitable

P = ParamSpec("P")
R = TypeVar("R")

OPTIONS = {
    "nogil": True,  # tiles run side by side on a thread pool
    "_nrt": False,
    "error_model": "numpy",  # x/0 is inf, as IEEE 754 says, and costs no branch
}

MAX_OLD_CACHES = 3  # folders of earlier versions that stay, so that switching between two checkouts stays quick


class NoEnvironment:
    @staticmethod
    def set_env(name: str, environment: object) -> None:
        """What Python's exceptions in machine code would need: there is none to raise them."""


class IrLibrary(JITCodeLibrary):
    """The code of a function that only kernels call: it becomes part of theirs.

    As LLVM's, for them to link and to optimise; machine code of its own would be for nobody. Numba's way, to optimise
    and to translate at each of a kernel's levels all that is below it, takes two thirds more time.
    """

    def _optimize_final_module(self) -> None:
        """Left to the kernels."""

    def _finalize_final_module(self) -> None:
        self._finalized = True

    @property
    def codegen(self) -> Any:
        """As far as it is asked for by whoever would call machine code: an object that takes its environment."""
        return NoEnvironment


class IrCompiler(Compiler):
    """Numba's compiler, for functions that only kernels call."""

    def compile_extra(self, func: Any) -> Any:
        self.state.library = IrLibrary(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


def inlined(function: Callable[P, R]) -> Callable[P, R]:
    """Mark a function that kernels may call; from Python it stays what it is."""
    return register_jitable(forceinline=True, pipeline_class=IrCompiler, **OPTIONS)(function)


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    return register_jitable(forceinline=False, pipeline_class=IrCompiler, **OPTIONS)(function)


class KernelCache(FunctionCache):
    """The machine code of one kernel on disk.

    To load it Numba first fills its tables of all that it can compile, which takes longer than the loading; nothing is
    to be compiled, so it has only what machine code itself calls set up.
    """

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            found = self._load_overload(sig, target_context)
        if found is None:
            target_context.refresh()
        return found


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Mark an entry point: compiled at its first call with these types, then loaded from `cache_folder`."""
    entry: Any = numba.njit(**OPTIONS)(function)
    cache_in(entry, cache_folder())
    return entry


def cache_in(entry: Any, folder: Path) -> None:
    """Where an entry point's machine code is loaded from and left."""
    if not hasattr(entry, "py_func"):
        return  # compiling is switched off
    before = numba.config.CACHE_DIR  # type: ignore[attr-defined]
    numba.config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        entry._cache = KernelCache(entry.py_func)
    finally:
        numba.config.CACHE_DIR = before  # type: ignore[attr-defined]


def is_compiled(entry: Any) -> bool:
    """Whether this entry point has machine code in this process (always, where compiling is switched off)."""
    return bool(getattr(entry, "signatures", True))


def is_cached(entry: Any) -> bool:
    """Whether an entry point's machine code is on disk, from an earlier start."""
    function = getattr(entry, "py_func", entry)
    name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}-*.nbi"
    return any(cache_folder().glob(f"*/{name}"))


@cache
def source_digest() -> str:
    """Of every source of this package: two with the same one trace the same."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.parent.rglob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


@cache
def versions() -> dict[str, str]:
    """What makes the machine code: processes where these are the same trace the same, on one kind of machine."""
    from importlib.metadata import version

    return {
        "raytree": f"{version('raytree')}/{source_digest()}",
        **{name: version(name) for name in ("numba", "llvmlite", "numpy")},
    }


@cache
def machine() -> dict[str, str]:
    """What else an image's last bits depend on."""
    import platform

    code: Any = cpu_target.target_context
    _, cpu, features = code.codegen().magic_tuple()
    return {
        "processor": f"{cpu}/{hashlib.sha256(features.encode()).hexdigest()[:8]}",
        "C library": " ".join(filter(None, platform.libc_ver())) or platform.platform(),  # has the power of highlights
    }


@cache
def cache_folder() -> Path:
    """Where machine code of exactly these sources is kept: the user's cache folder, else a temporary one."""
    name = f"kernels-{source_digest()}"
    for parent in (platformdirs.user_cache_path("raytree"), Path(tempfile.gettempdir()) / "raytree"):
        folder = parent / name
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                pass
        except OSError:
            continue
        os.utime(folder)
        _remove_old_caches(parent, folder)
        return folder
    return Path(tempfile.mkdtemp(prefix="raytree-"))


def _remove_old_caches(parent: Path, current: Path) -> None:
    """Remove the folders of versions not used lately; another process may be doing the same."""
    try:
        others = [folder for folder in parent.glob("kernels-*") if folder != current]
        others.sort(key=lambda folder: folder.stat().st_mtime, reverse=True)
    except OSError:
        return
    for folder in others[MAX_OLD_CACHES:]:
        shutil.rmtree(folder, ignore_errors=True)
