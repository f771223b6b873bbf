"""Starting other Python processes so that they run no file of the current folder.

Python puts the current folder first on the path of a process that it starts with `-c`. A file there that is called
like a module, say a student's `tracer.py` or `random.py`, would be run in its place. `-P` leaves the folder out.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

HOME = Path(__file__).parent.parent  # the folder that `tracer` is in
SAFE_PATH = "PYTHONSAFEPATH"  # the environment variable that means `-P`


def python_command(code: str) -> list[str]:
    """The command of a process that runs code. It finds `tracer` where this process did, installed or not."""
    return [sys.executable, "-P", "-c", f"import sys; sys.path.append({str(HOME)!r}); {code}"]


@contextmanager
def safe_path() -> Iterator[None]:
    """Within this context, processes that `multiprocessing` starts leave out the current folder: it has no option for
    `-P`, but they inherit the environment.
    """
    before = os.environ.get(SAFE_PATH)
    os.environ[SAFE_PATH] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[SAFE_PATH]
        else:
            os.environ[SAFE_PATH] = before
