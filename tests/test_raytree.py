"""The public module `raytree`, and files of the current folder that are called like modules of ours or of Python."""

import ast
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

import raytree
import tracer
from tests import ROOT

IN_THE_WAY = (  # imported by helper processes before they know where to look
    "tracer", "viewer", "numpy", "numba", "random", "multiprocessing", "threading", "socket", "signal", "tempfile",
    "struct", "subprocess", "pickle", "types", "selectors", "weakref", "bisect", "warnings",
)  # fmt: skip
PYTHON = [sys.executable, "-P"]  # as for the installed program, whose own folder is first on the path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a student's files. Each writes a file when it is run."""
    for name in IN_THE_WAY:
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'was_run')!r}, 'a').write({name!r} + '\\n')\n")
    return tmp_path


def run(*command: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        command, capture_output=True, text=True, cwd=cwd, env={**os.environ, **environment}, check=False
    )


def test_names_are_those_of_the_tracer_and_of_the_stub() -> None:
    stub = ast.parse((ROOT / "raytree" / "__init__.pyi").read_text())
    imported = {name.asname for node in ast.walk(stub) if isinstance(node, ast.ImportFrom) for name in node.names}
    assert imported | {"__version__"} == set(dir(raytree))
    assert set(dir(tracer)) < set(dir(raytree))
    for name in dir(tracer):
        assert getattr(raytree, name) is getattr(tracer, name)
    assert raytree.__version__ == version("raytree")
    with pytest.raises(AttributeError, match="raytree"):
        raytree.nothing  # type: ignore[attr-defined]  # noqa: B018


def test_figure_of_a_tree(worlds: dict[str, tracer.World]) -> None:
    tree = raytree.trace(worlds["plates"], (400, 300))
    assert raytree.tree_svg(tree) == tree._repr_svg_()


def test_importing_it_imports_nothing_heavy() -> None:
    program = "import sys, raytree\nprint(sorted({'numpy', 'numba', 'viewer', 'imgui_bundle'} & set(sys.modules)))"
    assert run(*PYTHON, "-c", program, cwd=ROOT).stdout.strip() == "[]"


@pytest.mark.parametrize("program", ["import raytree", "import tracer, raytree"])
def test_a_file_in_the_way_is_named_in_one_error(program: str, tmp_path: Path) -> None:
    own = tmp_path / "tracer.py"
    own.write_text("")
    (tmp_path / "homework.py").write_text(program)
    for command in (["-c", program], ["homework.py"]):
        found = run(sys.executable, *command, cwd=tmp_path)
        assert found.returncode == 1
        assert found.stderr.count("Error: ") == 1
        *_, line = found.stderr.splitlines()
        assert line.startswith(f"ImportError: {own} is in the way of raytree's own package tracer: rename it")


def test_a_file_in_the_way_of_the_figures_is_named_when_they_are_used(tmp_path: Path) -> None:
    own = tmp_path / "viewer.py"
    own.write_text("raise SystemExit('it was run')")
    found = run(sys.executable, "-c", "import raytree; print(raytree.load); raytree.tree_svg", cwd=tmp_path)
    assert "function load" in found.stdout
    assert found.stderr.splitlines()[-1].startswith(f"ImportError: {own} is in the way")


def test_processes_of_bounds_run_no_file_of_the_current_folder(folder: Path) -> None:
    command = str(Path(sys.executable).parent / "raytree")
    options = ("--size", "24x22", "--depth", "0", "--threads", "2")
    found = run(command, "render", "two-lights", "--bounds", "-o", "b.npy", *options, cwd=folder)
    assert (found.returncode, found.stderr) == (0, "")
    assert not (folder / "was_run").exists()


def test_the_compiling_process_runs_no_file_of_the_current_folder(folder: Path) -> None:
    """It finds the tracer, also if that is not installed: here only the program's own path has it."""
    program = f"import sys; sys.path.append({str(ROOT)!r})\n"
    program += "from viewer.session import warmup\n"
    program += "warmup.are_kernels_cached = lambda: False\n"
    program += "found = warmup.Warmup(print); found.wait(); print(found.child.returncode)\n"
    found = run(*PYTHON, "-c", program, cwd=folder)
    assert (found.returncode, found.stdout, found.stderr) == (0, "0\n", "")
    assert not (folder / "was_run").exists()
