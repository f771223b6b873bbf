"""Files are written under another name and renamed: an interrupted run leaves the old file or none, never a part."""

import contextlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any


class Unusable(Exception):
    """Input or arguments that cannot be used. The message has one line for each error."""

    def __init__(self, *faults: str) -> None:
        super().__init__("\n".join(faults))
        self.faults = faults


def collect(*checks: Callable[[], Any]) -> list[Any]:
    """Call all checks, and return their results. Raises Unusable with the faults of all of them."""
    given, faults = [], []
    for check in checks:
        try:
            given.append(check())
        except Unusable as unusable:
            faults += unusable.faults
    if faults:
        raise Unusable(*faults)
    return given


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file as a whole. Raises Unusable if the folder is not writable."""
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            os.chmod(name, 0o666 & ~_umask())
            os.replace(name, path)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(name)
            raise
    except OSError as error:
        raise Unusable(f"{path}: cannot be written: {error.strerror or error}") from None


def check_writable(path: Path) -> None:
    """Raise Unusable if the file cannot be written: before the work instead of after it."""
    if path.is_dir():
        raise Unusable(f"{path}: must be a file, got a folder")
    if not path.parent.is_dir():
        raise Unusable(f"{path}: folder not found: {path.parent}")
    if not os.access(path.parent, os.W_OK):
        raise Unusable(f"{path}: cannot be written: no permission for {path.parent}")


def check_folder(path: Path) -> None:
    """Raise Unusable if files cannot be written into this folder, which need not exist yet."""
    if path.exists() and not path.is_dir():
        raise Unusable(f"{path}: must be a folder, got a file")
    if not path.exists():
        check_writable(path)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def is_there(path: Path) -> bool:
    """Whether a file or folder exists. False for a name that cannot be one, for example because it is too long."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False
