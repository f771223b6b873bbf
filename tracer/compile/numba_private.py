"""Every private part of Numba that raytree uses, and why. All other files use its documented interface only.

| private part                                   | used for                                                       |
|------------------------------------------------|----------------------------------------------------------------|
| `JITCodeLibrary`, `Compiler`, `pipeline_class` | keep functions that only kernels call as LLVM IR: `IrLibrary`  |
| `FunctionCache`, `_cache`, `rtsys`             | load a kernel without the tables of compilation: `KernelCache` |
| the option `_nrt`                              | leave out reference counting: kernels allocate no memory       |
| `cpu_target`, `magic_tuple`                    | name the processor: `processor`                                |

Without the first three the kernel of an image takes 36 s to compile instead of 20, and 0.16 s to load instead of 0.09
(two cores of an AMD EPYC, numba 0.68).

They are tested up to the version TESTED. With a newer Numba they are left out: kernels are compiled by plain `njit`,
cached by Numba's own cache, and compute the same bits. `NOTE` says so.

`bundle`, `simd` and `intrinsics` build on Numba's interface for extensions (`numba.extending`, `numba.core.types`,
`datamodel`, `cgutils`), which is documented, and on `make_array` and `populate_array` of `numba.np.arrayobj`, which
Numba's own examples of extensions use. These are needed in any case.
"""

from pathlib import Path
from typing import Any

import numba

TESTED = (0, 68)  # the newest Numba that the private parts were tested with

_version = tuple(int(part) for part in numba.__version__.split(".")[:2])
USES_PRIVATE = _version <= TESTED

NOTE = (
    ""
    if USES_PRIVATE
    else f"numba {numba.__version__} is newer than the versions that raytree was tested with (up to "
    f"{TESTED[0]}.{TESTED[1]}): kernels are compiled by plain njit, and the first start takes about twice as long"
)

IR_ONLY: dict[str, Any] = {}  # options of functions that only kernels call
NO_RUNTIME: dict[str, Any] = {}  # options of all compiled functions

if USES_PRIVATE:
    from numba.core.caching import FunctionCache
    from numba.core.codegen import JITCodeLibrary
    from numba.core.compiler import Compiler
    from numba.core.runtime.nrt import rtsys

    class NoEnvironment:
        """Stands in for the machine code's environment, which only Python exceptions need: kernels raise none."""

        @staticmethod
        def set_env(name: str, environment: object) -> None:
            """Ignore the environment."""

    class IrLibrary(JITCodeLibrary):
        """A function as LLVM IR, without machine code of its own.

        Only kernels call it, and they link, inline and optimise its IR. Numba would also optimise it, and translate it
        to machine code, once for each level of calls above it.
        """

        def _optimize_final_module(self) -> None:
            """Leave optimisation to the kernels."""

        def _finalize_final_module(self) -> None:
            self._finalized = True

        @property
        def codegen(self) -> Any:
            return NoEnvironment

    class IrCompiler(Compiler):
        """Numba's compiler, with an `IrLibrary` for its result."""

        def compile_extra(self, func: Any) -> Any:
            self.state.library = IrLibrary(self.state.targetctx.codegen(), func.__qualname__)
            return super().compile_extra(func)

    class KernelCache(FunctionCache):
        """Machine code of one kernel on disk, loaded without the type tables that only compilation needs."""

        def load_overload(self, sig: Any, target_context: Any) -> Any:
            """The cached kernel for a signature, or None: only then are the tables of compilation filled."""
            rtsys.initialize(target_context)
            with self._guard_against_spurious_io_errors():
                found = self._load_overload(sig, target_context)
            if found is None:
                target_context.refresh()
            return found

    IR_ONLY["pipeline_class"] = IrCompiler
    NO_RUNTIME["_nrt"] = False


def use_cache_folder(entry: Any, folder: Path) -> None:
    """Cache the machine code of an entry point in `folder`. Numba itself takes the folder from a global setting."""
    config: Any = numba.config  # type: ignore[attr-defined]
    before = config.CACHE_DIR
    config.CACHE_DIR = str(folder)
    try:
        if USES_PRIVATE:
            entry._cache = KernelCache(entry.py_func)
        else:
            entry.enable_caching()
    finally:
        config.CACHE_DIR = before


def processor() -> tuple[str, str]:
    """(name, features) of the processor that kernels are compiled for."""
    try:
        from numba.core.registry import cpu_target

        context: Any = cpu_target.target_context
        _, cpu, features = context.codegen().magic_tuple()
    except (ImportError, AttributeError, ValueError):
        import platform

        return platform.processor() or platform.machine(), ""
    return cpu, features
