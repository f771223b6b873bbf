"""The cache of compiled kernels: nobody else can plant an entry, damaged entries are compiled anew, and where nothing
can be written the result is the same.
"""

import os
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests import ROOT

pytestmark = [
    pytest.mark.early,
    pytest.mark.skipif(not hasattr(os, "geteuid"), reason="Windows keeps the folders of users apart"),
]

STRANGER = 12345  # the number of another user
SMALL = """
from tracer.compile.jit import is_cached, kernel

@kernel
def double(x): return 2.0 * x

print(is_cached(double), double(21.0), is_cached(double))
"""


def run_small(folder: Path, **places: Path) -> str:
    """The output of the small program, with the user's cache and the folder for temporary files at these places."""
    program = folder / "program.py"
    program.write_text(SMALL)
    environment = {**os.environ, "XDG_CACHE_HOME": "/dev/null", **{name: str(path) for name, path in places.items()}}
    run = subprocess.run(
        [sys.executable, str(program)], capture_output=True, text=True, cwd=ROOT, env=environment, check=True
    )
    assert run.stderr == ""
    return run.stdout.strip()


class Trap:
    """Writes a file when it is unpickled."""

    def __init__(self, sprung: Path) -> None:
        self.sprung = sprung

    def __reduce__(self) -> tuple:
        return (Path.touch, (self.sprung,))


def give_away(folder: Path) -> None:
    if os.geteuid() != 0:
        pytest.skip("only root can make files of another user")
    for path in (folder, *folder.rglob("*")):
        os.chown(path, STRANGER, STRANGER)


def open_to_all(folder: Path) -> None:
    folder.chmod(0o777)


def link_from_elsewhere(folder: Path) -> None:
    give_away(folder)
    folder.rename(folder.with_name("elsewhere"))
    folder.symlink_to(folder.with_name("elsewhere"))


@pytest.mark.parametrize("plant", [give_away, open_to_all, link_from_elsewhere])
@pytest.mark.parametrize(
    "inner", [pytest.param(False, marks=pytest.mark.slow), True], ids=["outer folder", "inner folder"]
)
def test_an_entry_that_others_could_plant_is_not_loaded(
    plant: Callable[[Path], None], inner: bool, tmp_path: Path
) -> None:
    shared, sprung = tmp_path / "shared", tmp_path / "sprung"
    shared.mkdir()
    assert run_small(tmp_path, TMPDIR=shared) == "False 42.0 True"
    (folder,) = shared.iterdir()
    for index in folder.rglob("*.nbi"):
        index.write_bytes(pickle.dumps(Trap(sprung)))
    plant(next(folder.iterdir()) if inner else folder)
    assert "42.0" in run_small(tmp_path, TMPDIR=shared)
    assert not sprung.exists()


def test_the_cache_is_closed_to_others(tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    (tmp_path / "shared").mkdir()
    for places in ({"XDG_CACHE_HOME": tmp_path / "home"}, {"TMPDIR": tmp_path / "shared"}):
        run_small(tmp_path, **places)
        (outer,) = next(iter(places.values())).iterdir()
        for folder in (outer, *outer.iterdir()):
            assert folder.stat().st_mode & 0o777 == 0o700


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A folder with the program, and its cache. The place of a program is part of the names in a cache."""
    folder = tmp_path_factory.mktemp("program")
    cache = folder / "cache"
    assert run_small(folder, XDG_CACHE_HOME=cache) == "False 42.0 True"
    return folder, cache


def half(content: bytes) -> bytes:
    return content[: len(content) // 2]


def flipped(content: bytes) -> bytes:
    """One bit of the machine code is another one: it still unpickles."""
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


def empty(content: bytes) -> bytes:
    return b""


def garbage(content: bytes) -> bytes:
    return b"\x80garbage" * 100


@pytest.mark.parametrize(
    "damage", [half, flipped, *(pytest.param(damage, marks=pytest.mark.slow) for damage in (empty, garbage))]
)
@pytest.mark.parametrize("kind", ["nbi", "nbc"])
def test_a_damaged_entry_is_compiled_anew(
    kind: str, damage: Callable[[bytes], bytes], filled: tuple[Path, Path], tmp_path: Path
) -> None:
    folder, cache = filled
    own = tmp_path / "cache"
    shutil.copytree(cache, own)
    (entry,) = own.rglob(f"program.double-*.{kind}")
    entry.write_bytes(damage(entry.read_bytes()))
    assert run_small(folder, XDG_CACHE_HOME=own) == "False 42.0 True"
    assert run_small(folder, XDG_CACHE_HOME=own) == "True 42.0 True"


def test_a_cache_that_cannot_be_written_costs_no_result(filled: tuple[Path, Path], tmp_path: Path) -> None:
    folder, cache = filled
    own = tmp_path / "cache"
    shutil.copytree(cache, own)
    (entry,) = own.rglob("program.double-*.nbi")
    shutil.rmtree(entry.parent)
    entry.parent.write_text("a file in the place of the folder")
    assert run_small(folder, XDG_CACHE_HOME=own) == "False 42.0 False"
    shared = tmp_path / "shared"
    shared.mkdir()
    (shared / f"raytree-{os.geteuid()}").write_text("a file in the place of the folder")
    assert run_small(tmp_path, TMPDIR=shared) == "False 42.0 False"
    assert [path.name for path in shared.iterdir()] == [f"raytree-{os.geteuid()}"]


def test_the_command_line_notes_that_kernels_cannot_be_kept(tmp_path: Path) -> None:
    (tmp_path / f"raytree-{os.geteuid()}").write_text("a file in the place of the folder")
    program = "from unittest.mock import patch\nfrom viewer.cli import terminal\n"
    program += "with patch.object(terminal, 'fill_cache', lambda batch: None): terminal.compile_once()\n"
    environment = {**os.environ, "XDG_CACHE_HOME": "/dev/null", "TMPDIR": str(tmp_path)}
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=True)
    *_, note = run.stderr.splitlines()
    assert note.startswith("note: compiled kernels cannot be kept in /dev/null/raytree or in ")
