"""Under a Numba newer than the tested ones its private parts are not used, a note says so, and results are equal."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import tracer
from tests import ROOT
from tracer.compile import numba_private
from viewer.lessons import lesson

NEWER = "import numba\nnumba.__version__ = '99.0.0'\n"
SMALL = """
from tracer.compile.jit import compiled, inlined, is_cached, kernel
from tracer.compile import numba_private

@inlined
def double(x): return 2.0 * x

@compiled
def triple(x): return 3.0 * x

@kernel
def six(x): return double(triple(x))

print(six(7.0), numba_private.USES_PRIVATE, numba_private.IR_ONLY, numba_private.NO_RUNTIME)
print(numba_private.NOTE)
"""
IMAGE = """
import hashlib, tracer
world = tracer.prepare(tracer.load({path!r}))
print(hashlib.sha256(tracer.render(world, (160, 120)).pixels.tobytes()).hexdigest())
"""


def newer(program: str, folder: Path) -> list[str]:
    """The lines that a program prints under a Numba that calls itself version 99."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder)}
    script = folder / "program.py"
    script.write_text(NEWER + program)
    command = [sys.executable, str(script)]
    run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT, env=environment)
    return run.stdout.splitlines()


def test_private_parts_are_left_out_and_a_note_says_so(tmp_path: Path) -> None:
    assert numba_private.USES_PRIVATE and not numba_private.NOTE  # in the installed version
    result, note = newer(SMALL, tmp_path)
    assert result == "42.0 False {} {}"
    assert note.startswith("numba 99.0.0 is newer than the versions that raytree was tested with")
    assert list(tmp_path.rglob("program.six-*.nbi"))


def test_command_line_prints_the_note(tmp_path: Path) -> None:
    program = "import sys\nfrom unittest.mock import patch\nsys.stderr = sys.stdout\n"
    program += "from viewer.cli import terminal\n"
    program += "with patch.object(terminal, 'missing_kernels', lambda batch: 0): terminal.compile_once()\n"
    (line,) = newer(program, tmp_path)
    assert line.startswith("note: numba 99.0.0 is newer")


@pytest.mark.slow  # compiles the kernels by plain njit
@pytest.mark.timeout(600)
def test_the_bits_are_the_same(tmp_path: Path) -> None:
    import hashlib

    path = lesson.read("glass-ball").scene
    ours = tracer.render(tracer.prepare(tracer.load(path)), (160, 120)).pixels
    assert newer(IMAGE.format(path=str(path)), tmp_path) == [hashlib.sha256(ours.tobytes()).hexdigest()]
