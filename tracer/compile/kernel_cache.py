"""The folder on disk that holds compiled kernels, and what identifies their machine code.

The folder's name is a hash of every source file of `tracer`. Numba by itself only notices a change in the entry
point's own file, and would go on using machine code of functions that have changed since.

Kernels are stored with pickle, and whoever can write such a file can run code in this process. So the folder belongs
to this user, and nobody else may write into it.
"""

import hashlib
import os
import shutil
import stat
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

import platformdirs

from tracer.compile.numba_private import processor
from tracer.printable import shown_path

MAX_OLD_CACHES = 3  # folders of other versions that are kept, so that switching between two checkouts stays fast
OTHERS_WRITE = 0o022  # mode bits: the group and all others may write
STALE = 3600.0  # seconds after which a file that is being written has been abandoned


@cache
def source_digest() -> str:
    """Hash of every source file of `tracer`: two installations with the same one trace the same bits."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.parent.rglob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


@cache
def versions() -> dict[str, str]:
    """Versions of the packages that produce machine code. On one machine, processes that agree in them trace the same
    bits.
    """
    from importlib.metadata import version

    return {
        "raytree": f"{version('raytree')}/{source_digest()}",
        **{name: version(name) for name in ("numba", "llvmlite", "numpy")},
    }


@cache
def machine() -> dict[str, str]:
    """Properties of this machine that the last bits of an image depend on."""
    import platform

    cpu, features = processor()
    return {
        "processor": f"{cpu}/{hashlib.sha256(features.encode()).hexdigest()[:8]}",
        "C library": " ".join(filter(None, platform.libc_ver())) or platform.platform(),  # computes pow for highlights
    }


@cache
def cache_folder() -> Path | None:
    """The folder for machine code of exactly these sources: in the user's cache, else in the folder for temporary
    files. None if neither has a folder that only this user can write into; kernels are then compiled at every start.
    """
    name = f"kernels-{source_digest()}"
    for parent in _parents():
        folder = parent / name
        try:
            parent.parent.mkdir(parents=True, exist_ok=True)
            for each in (parent, folder):
                make_private(each)
            with tempfile.TemporaryFile(dir=folder):
                pass
            os.utime(folder)
        except OSError:
            continue
        _remove_old_caches(parent, folder)
        _remove_stale_files(folder)
        return folder
    return None


def unwritable_cache() -> str:
    """One line for the user, for when the compiled kernels could not be stored."""
    folder = cache_folder()
    tried = [folder] if folder else list(_parents())
    places = " or in ".join(map(shown_path, tried)) or "any folder of this user"
    return f"compiled kernels cannot be kept in {places}, so every start compiles them"


def _parents() -> Iterator[Path]:
    """The folders of raytree in the user's cache and, with the user's number, in the folder for temporary files."""
    with suppress(RuntimeError):  # the user has no home
        yield platformdirs.user_cache_path("raytree")
    with suppress(OSError):  # there is no folder for temporary files
        yield Path(tempfile.gettempdir()) / (f"raytree-{os.getuid()}" if hasattr(os, "getuid") else "raytree")


def make_private(folder: Path) -> None:
    """Make a folder that only this user can read and write. If there is one that others could write into, it is closed
    to them and emptied. OSError if there is something else of this name: a file, a link, a folder of another user.

    Windows keeps the folders of users apart by itself.
    """
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    status = folder.lstat()
    if not stat.S_ISDIR(status.st_mode):
        raise NotADirectoryError(f"{folder} is not a folder")
    if not hasattr(os, "geteuid"):
        return
    if status.st_uid != os.geteuid():
        raise PermissionError(f"{folder} belongs to another user")
    if status.st_mode & OTHERS_WRITE:
        folder.chmod(0o700)
        for content in folder.iterdir():
            if content.is_dir() and not content.is_symlink():
                shutil.rmtree(content)
            else:
                content.unlink()


def _remove_old_caches(parent: Path, current: Path) -> None:
    """Remove the folders of versions that were used longest ago. Another process may be doing the same."""
    try:
        others = [folder for folder in parent.glob("kernels-*") if folder != current]
        others.sort(key=lambda folder: folder.stat().st_mtime, reverse=True)
    except OSError:
        return
    for folder in others[MAX_OLD_CACHES:]:
        shutil.rmtree(folder, ignore_errors=True)


def _remove_stale_files(folder: Path) -> None:
    """Remove what processes left that were killed while they wrote an entry, which takes some milliseconds."""
    for path in folder.glob("*/*.tmp.*"):
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > STALE:
                path.unlink()
