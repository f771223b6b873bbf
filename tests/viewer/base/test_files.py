"""Files are replaced as a whole; links, devices, pipes and write-protected files are treated as their owner expects."""

import os
import signal
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from tests import ROOT
from tests.viewer.cli.test_cli import raytree
from viewer.base.files import Unusable, part_file, write_atomically

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="about links, pipes and modes of Unix")

KILLED = """
import os, sys
from pathlib import Path
from viewer.base.files import part_file
with part_file(Path(sys.argv[1])) as part:
    part.file.write(b"half")
    part.file.flush()
    print(part.path, flush=True)
    sys.stdin.readline()
"""


def test_the_file_behind_a_link_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    target, link, chain = tmp_path / "there" / "old.txt", tmp_path / "link.txt", tmp_path / "chain.txt"
    target.write_text("old")
    before = target.stat().st_ino
    link.symlink_to(Path("there") / "old.txt")
    chain.symlink_to("link.txt")
    write_atomically(chain, b"new")
    assert (target.read_text(), target.is_symlink()) == ("new", False)
    assert target.stat().st_ino != before  # it was replaced, not written over
    assert (link.readlink(), chain.readlink()) == (Path("there") / "old.txt", Path("link.txt"))
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["chain.txt", "link.txt", "old.txt", "there"]


def test_links_to_nothing_and_in_a_circle(tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to("new")
    write_atomically(link, b"new")
    assert (link.readlink(), (tmp_path / "new").read_text()) == (Path("new"), "new")
    circle = tmp_path / "circle"
    circle.symlink_to("circle")
    with pytest.raises(Unusable, match="circle: cannot be written: Too many levels"):
        write_atomically(circle, b"new")
    away = tmp_path / "away"
    away.symlink_to("nowhere/file")
    with pytest.raises(Unusable, match=r"away: folder not found: .*nowhere"):
        write_atomically(away, b"new")


def device(path: Path, minor: int) -> Path:
    """A memory device of Linux (1 and this number) of our own: root could destroy the system's."""
    try:
        os.mknod(path, stat.S_IFCHR | 0o666, os.makedev(1, minor))
        path.open("rb").close()
    except PermissionError:
        pytest.skip("no device can be made here")
    return path


def test_a_pipe_and_a_device_are_written_to(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    write_atomically(pipe, b"through the pipe" * 10_000)
    reader.join()
    assert read == [b"through the pipe" * 10_000]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    null, full = device(tmp_path / "null", 3), device(tmp_path / "full", 7)
    write_atomically(null, b"nowhere")
    assert stat.S_ISCHR(null.stat().st_mode)
    with pytest.raises(Unusable, match="full: cannot be written: No space left on device"):
        write_atomically(full, b"nowhere")


def test_standard_output_that_is_a_file_is_appended_to(tmp_path: Path) -> None:
    """By a name in which nobody can make a file, so that the system's own names are safe from this test."""
    log = tmp_path / "log"
    log.write_text("old\n")
    program = "from pathlib import Path\nfrom viewer.base.files import write_atomically\n"
    program += "write_atomically(Path('/proc/self/fd/1'), b'new\\n')"
    with log.open("ab") as file:
        subprocess.run([sys.executable, "-c", program], stdout=file, check=True, cwd=ROOT)
    assert log.read_text() == "old\nnew\n"


def test_a_file_without_write_permission_stays_also_for_root(tmp_path: Path) -> None:
    for path in (tmp_path / "kept.npy", tmp_path / "behind.npy"):
        path.write_text("old")
        path.chmod(0o444)
    (tmp_path / "link.npy").symlink_to("behind.npy")
    for name in ("kept.npy", "link.npy"):
        found = raytree("render", "two-lights", "-o", name, "--size", "4x4", cwd=tmp_path)
        assert (found.returncode, found.stdout) == (2, "")
        assert found.stderr == f"{name}: cannot be written: no permission to change this file\n"
    assert (tmp_path / "kept.npy").read_text() == (tmp_path / "behind.npy").read_text() == "old"


def test_a_new_version_has_the_mode_of_the_old_one(tmp_path: Path) -> None:
    path = tmp_path / "private"
    path.write_text("old")
    path.chmod(0o600)
    write_atomically(path, b"new")
    assert (path.read_text(), path.stat().st_mode & 0o777) == ("new", 0o600)
    if os.geteuid() == 0:
        os.chown(path, 12345, 12345)
        write_atomically(path, b"newer")
        assert (path.stat().st_uid, path.stat().st_gid) == (12345, 12345)


@pytest.mark.parametrize("long", ["n" * 250, "n" * 300])
def test_long_names(long: str, tmp_path: Path) -> None:
    path = tmp_path / long
    if len(long) < 256:
        write_atomically(path, b"new")
        assert path.read_text() == "new"
        return
    found = raytree("render", "two-lights", "-o", f"{long}.png", cwd=tmp_path)
    assert found.returncode == 2
    assert found.stderr == f"{long}.png: cannot be written: File name too long\n"


def test_what_killed_processes_left_is_removed_and_nothing_else(tmp_path: Path) -> None:
    kept = [".raytree-notes.part", "raytree-0123456789abcdef.part", ".raytree-0123456789abcdef.part.txt", ".hidden"]
    for name in kept:
        (tmp_path / name).write_text("mine")
    (tmp_path / ".raytree-00000000deadbeef.part").symlink_to(".hidden")
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", KILLED, str(tmp_path)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )
        for _ in range(2)
    ]
    parts = [Path(process.stdout.readline().strip()) for process in processes if process.stdout]
    processes[0].send_signal(signal.SIGKILL)
    processes[0].wait()
    assert all(part.exists() for part in parts)
    write_atomically(tmp_path / "new", b"new")
    assert not parts[0].exists()
    assert parts[1].exists()  # its writer lives
    processes[1].communicate("\n")
    assert processes[1].returncode == 0
    assert not parts[1].exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*kept, ".raytree-00000000deadbeef.part", "new"])


def test_any_command_removes_them_from_the_current_folder(tmp_path: Path) -> None:
    (tmp_path / ".raytree-0123456789abcdef.part").write_text("left")
    assert raytree("lessons", cwd=tmp_path).returncode == 0
    assert list(tmp_path.iterdir()) == []


def test_parts_of_another_user_stay(tmp_path: Path) -> None:
    if os.geteuid() != 0:
        pytest.skip("only root can make files of another user")
    part = tmp_path / ".raytree-0123456789abcdef.part"
    part.write_text("theirs")
    os.chown(part, 12345, 12345)
    with part_file(tmp_path):
        assert part.exists()
