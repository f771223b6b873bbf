"""Every private part of Numba that raytree uses, and why. All other files use its documented interface only.

| private part                                   | used for                                                       |
|------------------------------------------------|----------------------------------------------------------------|
| `JITCodeLibrary`, `Compiler`, `pipeline_class` | keep functions that only kernels call as LLVM IR: `IrLibrary`  |
| `FunctionCache`, `_cache`, `rtsys`             | load a kernel without the tables of compilation: `KernelCache` |
| `IndexDataCacheFile`, `CompileResultCacheImpl` | find damage in the files of that cache: `CheckedFiles`         |
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

import contextlib
import io
import pickle
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

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

CHECKSUM = 4  # bytes
IR_ONLY: dict[str, Any] = {}  # options of functions that only kernels call
NO_RUNTIME: dict[str, Any] = {}  # options of all compiled functions

if USES_PRIVATE:
    from numba.core.caching import (
        CompileResultCacheImpl,
        FunctionCache,
        IndexDataCacheFile,
        UserProvidedCacheLocator,
    )
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

    class CheckedFiles(IndexDataCacheFile):
        """The index and the data of one kernel, each with a checksum in front.

        Numba reads what is there. A truncated file would be an exception of any kind, and altered machine code a crash.
        """

        def load(self, key: Any) -> Any:
            """The data of a key; None if there are none or they are damaged. Damaged files are removed."""
            try:
                return super().load(key)
            except Exception:  # unpickling may raise any; a kernel is compiled anew, whatever is wrong with its file
                self.discard()
                return None

        def save(self, key: Any, data: Any) -> None:
            """Store data. Where nothing can be written, they are only used: see `is_cached` in `jit`."""
            self.load(key)  # removes a damaged index, which Numba would read
            with contextlib.suppress(OSError):
                super().save(key, data)

        def discard(self) -> None:
            """Remove the kernel's files."""
            index = Path(self._index_path)
            stem = index.name.removesuffix("nbi")
            for path in [index, *index.parent.glob(f"{stem}*.nbc")]:
                with contextlib.suppress(OSError):
                    path.unlink()

        def are_whole(self) -> bool:
            """Whether there is an index, and it and its data are not damaged."""
            try:
                names = self._load_index().values()
                for name in names:
                    self._checked(self._data_path(name))
            except Exception:  # as in `load`
                return False
            return bool(names)

        def _load_index(self) -> dict[Any, str]:
            try:
                content = io.BytesIO(self._checked(self._index_path))
            except FileNotFoundError:
                return {}
            if pickle.load(content) != self._version:
                return {}
            stamp, overloads = pickle.load(content)
            return overloads if stamp == self._source_stamp else {}

        def _load_data(self, name: str) -> Any:
            return pickle.loads(self._checked(self._data_path(name)))

        @staticmethod
        def _checked(path: str) -> memoryview:
            """The content of a file, without its checksum. ValueError if the checksum is another one."""
            found = memoryview(Path(path).read_bytes())
            if zlib.crc32(found[CHECKSUM:]).to_bytes(CHECKSUM, "little") != found[:CHECKSUM]:
                raise ValueError(f"{path} is damaged")
            return found[CHECKSUM:]

        @contextlib.contextmanager
        def _open_for_write(self, filepath: str) -> Iterator[BinaryIO]:
            content = io.BytesIO()
            yield content
            written = content.getvalue()
            with super()._open_for_write(filepath) as file:
                file.write(zlib.crc32(written).to_bytes(CHECKSUM, "little"))
                file.write(written)

    class OneFolder(CompileResultCacheImpl):
        """A cache in the folder that it was given, and never in another: Numba would also try the folder of the source
        file, and the user's cache of Numba.
        """

        _locator_classes = (UserProvidedCacheLocator,)

    class KernelCache(FunctionCache):
        """Machine code of one kernel on disk, loaded without the type tables that only compilation needs."""

        _impl_class = OneFolder

        def __init__(self, function: Any) -> None:
            super().__init__(function)
            files = self._cache_file
            self._cache_file = CheckedFiles(self._cache_path, self._impl.filename_base, files._source_stamp)

        def load_overload(self, sig: Any, target_context: Any) -> Any:
            """The cached kernel for a signature, or None: only then are the tables of compilation filled."""
            rtsys.initialize(target_context)
            with self._guard_against_spurious_io_errors():
                found = self._load_overload(sig, target_context)
            if found is None:
                target_context.refresh()
            return found

        def save_overload(self, sig: Any, data: Any) -> None:
            """Store a compiled kernel, if its folder can be written."""
            with contextlib.suppress(OSError):
                super().save_overload(sig, data)

        def is_whole(self) -> bool:
            """Whether the kernel can be loaded."""
            return self._cache_file.are_whole()

    IR_ONLY["pipeline_class"] = IrCompiler
    NO_RUNTIME["_nrt"] = False


def use_cache_folder(entry: Any, folder: Path) -> None:
    """Cache the machine code of an entry point in `folder`, if that can be written. Numba itself takes the folder from
    a global setting.
    """
    config: Any = numba.config  # type: ignore[attr-defined]
    before = config.CACHE_DIR
    config.CACHE_DIR = str(folder)
    try:
        if USES_PRIVATE:
            entry._cache = KernelCache(entry.py_func)
        else:
            entry.enable_caching()
    except RuntimeError:  # Numba found no folder
        return
    finally:
        config.CACHE_DIR = before


def is_stored(entry: Any, folder: Path) -> bool:
    """Whether the machine code of an entry point is in `folder`, undamaged."""
    if USES_PRIVATE:
        return isinstance(entry._cache, KernelCache) and entry._cache.is_whole()
    function = entry.py_func
    return any(folder.glob(f"*/{function.__module__.rpartition('.')[2]}.{function.__name__}-*.nbi"))


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
