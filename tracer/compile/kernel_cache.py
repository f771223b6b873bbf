"""The folder on disk that holds compiled kernels, and what identifies their machine code.

The folder's name is a hash of every source file of `tracer`. Numba by itself only notices a change in the entry
point's own file, and would go on using machine code of functions that have changed since.
"""

import hashlib
import os
import shutil
import tempfile
from functools import cache
from pathlib import Path

import platformdirs

from tracer.compile.numba_private import processor

MAX_OLD_CACHES = 3  # folders of other versions that are kept, so that switching between two checkouts stays fast


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
def cache_folder() -> Path:
    """The folder for machine code of exactly these sources: in the user's cache, else in a temporary folder."""
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
    """Remove the folders of versions that were used longest ago. Another process may be doing the same."""
    try:
        others = [folder for folder in parent.glob("kernels-*") if folder != current]
        others.sort(key=lambda folder: folder.stat().st_mtime, reverse=True)
    except OSError:
        return
    for folder in others[MAX_OLD_CACHES:]:
        shutil.rmtree(folder, ignore_errors=True)
