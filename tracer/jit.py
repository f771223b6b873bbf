"""The one place that knows Numba: how kernels are compiled and where the machine code is kept.

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
from llvmlite import ir
from numba import types
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import cpu_target
from numba.core.runtime.nrt import rtsys
from numba.extending import lower_builtin, register_jitable, type_callable

P = ParamSpec("P")
R = TypeVar("R")

OPTIONS = {
    "nogil": True,  # tiles run side by side on a thread pool
    "_nrt": False,
    "error_model": "numpy",  # x/0 is inf, as IEEE 754 says, and costs no branch
}

CACHE_LINE = 64  # bytes
KEPT_CACHES = 3  # folders of earlier versions that stay, so that switching between two checkouts stays quick


class NoMemory:
    @staticmethod
    def set_env(name: str, environment: object) -> None:
        """What Python's exceptions in machine code would need: there is none to raise them."""


class Part(JITCodeLibrary):
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
        return NoMemory


class PartCompiler(Compiler):
    """Numba's compiler, for functions that only kernels call."""

    def compile_extra(self, func: Any) -> Any:
        self.state.library = Part(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Mark a function that kernels may call; from Python it stays what it is."""
    return register_jitable(forceinline=True, pipeline_class=PartCompiler, **OPTIONS)(function)


def routine(function: Callable[P, R]) -> Callable[P, R]:
    return register_jitable(forceinline=False, pipeline_class=PartCompiler, **OPTIONS)(function)


def stay_apart() -> None:
    """As a function's first line: do not copy it into its callers. For what is large and seldom needed."""


@type_callable(stay_apart)
def _type_stay_apart(context: Any) -> Any:
    return lambda: types.none


@lower_builtin(stay_apart)
def _lower_stay_apart(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    builder.function.attributes.add("noinline")
    return context.get_dummy_value()


def natural(number: int) -> int:
    """A number that is never negative: as an index it is taken as it is, and not asked whether it counts from the end.

    For what waits for it, as a search for its next box does, the question would cost a tenth of the time.
    """
    return number


@type_callable(natural)
def _type_natural(context: Any) -> Any:
    return lambda number: types.uint64


@lower_builtin(natural, types.Integer)
def _lower_natural(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return context.cast(builder, arguments[0], signature.args[0], types.uint64)


def soon(rows: Any, number: int) -> None:
    """This row of an array will be asked for: it can be fetched from memory meanwhile."""


@type_callable(soon)
def _type_soon(context: Any) -> Any:
    return lambda rows, number: types.none


@lower_builtin(soon, types.Array, types.Integer)
def _lower_soon(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    from numba.np.arrayobj import make_array  # only where something is compiled

    kind = signature.args[0]
    size, byte, word, short = kind.dtype.size, ir.IntType(8).as_pointer(), ir.IntType(64), ir.IntType(32)
    data = builder.bitcast(make_array(kind)(context, builder, arguments[0]).data, byte)
    number = context.cast(builder, arguments[1], signature.args[1], types.int64)
    row = builder.gep(data, [builder.mul(number, word(size))])
    prefetch = builder.module.declare_intrinsic(
        "llvm.prefetch", (byte,), ir.FunctionType(ir.VoidType(), [byte, short, short, short])
    )
    for line in range(0, size, CACHE_LINE):
        builder.call(prefetch, [builder.gep(row, [word(line)]), short(0), short(3), short(1)])  # to read, to keep, data
    return context.get_dummy_value()


SPLIT = 2.0**27 + 1.0


def product_error(a: Any, b: Any, product: Any) -> Any:
    """a b - product, where product is a b rounded: a float, without an error.

    Compiled it is one instruction (IEEE 754, 5.4.1: fusedMultiplyAdd). Python before 3.13 has none: there the factors
    are split into halves whose products are exact (Dekker, Numerische Mathematik 18, 1971); arrays may be given too.
    """
    a_high = SPLIT * a - (SPLIT * a - a)
    b_high = SPLIT * b - (SPLIT * b - b)
    a_low, b_low = a - a_high, b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


@type_callable(product_error)
def _type_product_error(context: Any) -> Any:
    return lambda a, b, product: types.float64


@lower_builtin(product_error, types.float64, types.float64, types.float64)
def _lower_product_error(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    a, b, product = arguments
    return builder.fma(a, b, builder.fneg(product))


class Kept(FunctionCache):
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
    before = numba.config.CACHE_DIR  # type: ignore[attr-defined]
    numba.config.CACHE_DIR = str(cache_folder())  # type: ignore[attr-defined]
    try:
        entry: Any = numba.njit(**OPTIONS)(function)
        if hasattr(entry, "py_func"):  # and compiling is not switched off
            entry._cache = Kept(function)
        return entry
    finally:
        numba.config.CACHE_DIR = before  # type: ignore[attr-defined]


def is_compiled(entry: Any) -> bool:
    """Whether this entry point has machine code in this process (always, where compiling is switched off)."""
    return bool(getattr(entry, "signatures", True))


def is_cached(entry: Any) -> bool:
    """Whether an entry point's machine code is on disk, from an earlier start."""
    function = getattr(entry, "py_func", entry)
    name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}-*.nbi"
    return any(cache_folder().rglob(name))


@cache
def source_digest() -> str:
    """Of every source of this package: two with the same one trace the same."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.rglob("*.py")):
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
        _forget_old(parent, folder)
        return folder
    return Path(tempfile.mkdtemp(prefix="raytree-"))


def _forget_old(parent: Path, current: Path) -> None:
    """Remove the folders of versions not used lately; another process may be doing the same."""
    try:
        others = [folder for folder in parent.glob("kernels-*") if folder != current]
        others.sort(key=lambda folder: folder.stat().st_mtime, reverse=True)
    except OSError:
        return
    for folder in others[KEPT_CACHES:]:
        shutil.rmtree(folder, ignore_errors=True)
