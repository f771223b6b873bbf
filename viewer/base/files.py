"""The one place that writes files. A file is written under another name and renamed: an interrupted run leaves the old
file or none, never a part.

The other name is like `.raytree-0123456789abcdef.part`, in the same folder, and its writer holds a lock on it. So a
part without a lock was left by a process that was killed; whoever writes into the folder next removes it.
"""

import contextlib
import os
import re
import secrets
import stat
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from tracer.printable import printable

try:
    import fcntl
except ImportError:  # Windows, where nobody removes parts
    fcntl = None

PART = re.compile(r"\.raytree-[0-9a-f]{16}\.part")
OPEN_FILES = ("/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/")  # names that stand for files that are open already


class Unusable(Exception):
    """Input or arguments that cannot be used. The message has one line for each error."""

    def __init__(self, *faults: str) -> None:
        self.faults = tuple(map(printable, faults))
        super().__init__("\n".join(self.faults))


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
    """Write a file as a whole. Raises Unusable as `check_writable`, or if the disk is full.

    If the path is a link, the file behind it is replaced. A new version has the mode of the old one, and its owner, if
    this user may give files away. A device, a pipe or a file that is open already, like /dev/stdout, is written to.
    """
    status = check_writable(path)
    try:
        if status is not None and (not stat.S_ISREG(status.st_mode) or is_open_file(path)):
            with path.open("ab") as file:
                file.write(content)
            return
        target = Path(os.path.realpath(path))
        with part_file(target.parent, 0o666 if status is None else 0o600) as part:
            if status is not None:
                keep_owner(part.path, status)
            part.file.write(content)
            part.file.flush()
            if fcntl is None:
                part.file.close()  # Windows cannot rename an open file
            part.path.replace(target)
    except OSError as error:
        raise Unusable(f"{path}: cannot be written: {error.strerror or error}") from None


def check_writable(path: Path) -> os.stat_result | None:
    """Raise Unusable if the file cannot be written: before the work instead of after it. Returns the status of the file
    that is there, or behind a link; None if there is none.

    A file without write permission is refused, also for root, whom the system would let pass.
    """
    status = status_of(path)
    if status is not None:
        if stat.S_ISDIR(status.st_mode):
            raise Unusable(f"{path}: must be a file, got a folder")
        is_root = hasattr(os, "geteuid") and os.geteuid() == 0
        if not (status.st_mode & stat.S_IWUSR if is_root else os.access(path, os.W_OK)):
            raise Unusable(f"{path}: cannot be written: no permission to change this file")
        if not stat.S_ISREG(status.st_mode) or is_open_file(path):
            return status
    folder = Path(os.path.realpath(path)).parent
    if not folder.is_dir():
        raise Unusable(f"{path}: folder not found: {folder if path.is_symlink() else path.parent}")
    if not os.access(folder, os.W_OK):
        raise Unusable(f"{path}: cannot be written: no permission for {folder if path.is_symlink() else path.parent}")
    return status


def status_of(path: Path) -> os.stat_result | None:
    """The status of a file, or of the one behind a link; None if there is none. Unusable if there cannot be one."""
    try:
        return path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:
        raise Unusable(f"{path}: cannot be written: {getattr(error, 'strerror', None) or error}") from None


def is_open_file(path: Path) -> bool:
    """Whether a path stands for a file that is open already. It is not replaced: others go on writing to it."""
    return str(path.absolute()).startswith(OPEN_FILES)


def keep_owner(path: Path, old: os.stat_result) -> None:
    """Give a new file the owner and the mode of the one that it replaces, as far as this user may."""
    if hasattr(os, "chown"):
        with contextlib.suppress(OSError):
            os.chown(path, old.st_uid, old.st_gid)
    path.chmod(old.st_mode & 0o777)


class Part(NamedTuple):
    """A file that is not finished."""

    path: Path
    file: BinaryIO


@contextlib.contextmanager
def part_file(folder: Path, mode: int = 0o666) -> Iterator[Part]:
    """A new file in a folder, under a name that says that it is not finished. It is gone at the end, unless it was
    renamed. Removes the parts that killed processes have left there.
    """
    remove_stale_parts(folder)
    part = _new_part(folder, mode)
    try:
        with part.file:
            yield part
    finally:
        part.path.unlink(missing_ok=True)


def _new_part(folder: Path, mode: int) -> Part:
    while True:
        path = folder / f".raytree-{secrets.token_hex(8)}.part"
        file = os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), mode), "wb")
        if fcntl is None:
            return Part(path, file)
        with contextlib.suppress(OSError):  # the file system has no locks: then nobody removes parts there
            fcntl.flock(file, fcntl.LOCK_EX)
        if path.exists():
            return Part(path, file)
        file.close()  # another process took it for a stale one before it was locked


def remove_stale_parts(folder: Path) -> None:
    """Remove the parts that processes of this user have left in a folder when they were killed."""
    if fcntl is None:
        return
    try:
        found = [path for path in folder.glob(".raytree-*.part") if PART.fullmatch(path.name)]
    except OSError:
        return
    for path in found:
        with contextlib.suppress(OSError), os.fdopen(os.open(path, os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
            status = os.fstat(file.fileno())
            if stat.S_ISREG(status.st_mode) and status.st_uid == os.geteuid():
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)  # OSError while its writer lives
                path.unlink()


def check_folder(path: Path) -> None:
    """Raise Unusable if files cannot be written into this folder, which need not exist yet."""
    if has_folder(path):
        return
    if is_there(path):
        raise Unusable(f"{path}: must be a folder, got a file")
    check_writable(path)


def is_there(path: Path) -> bool:
    """Whether a file or folder exists. False for a name that cannot be one, for example because it is too long."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def has_folder(path: Path) -> bool:
    """Whether there is a folder of this name. False for a name that cannot be one."""
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def free_path(path: Path) -> Path:
    """This path, or the next one with a number that does not exist."""
    names = (path.with_stem(f"{path.stem}-{k}") if k > 1 else path for k in range(1, 10**6))
    return next(name for name in names if not name.exists())
