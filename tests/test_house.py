"""The house's rules that a program can check: who may know whom, and how long a file may get."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests import ROOT

ROOMS = ("tracer", "viewer")
SOURCES = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]


def imports(path: Path) -> set[str]:
    tree = ast.parse(path.read_text("utf-8"))
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
    return found


def test_tracer_never_imports_the_viewer_nor_its_libraries() -> None:
    for path in SOURCES:
        if path.is_relative_to(ROOT / "tracer"):
            tops = {name.split(".")[0] for name in imports(path)}
            assert not tops & {"viewer", "moderngl", "glfw", "imgui_bundle", "PIL", "shaders", "lessons"}, path


def test_one_place_knows_each_library() -> None:
    """Numba: `jit` and what compiled code is made of; glfw: `window`; trimesh: `formats.meshes`; Dask: `cluster`;
    a file's format: its writer.
    """
    homes = {
        "numba": {
            "tracer/compile/jit.py",
            "tracer/compile/intrinsics.py",
            "tracer/compile/bundle.py",
            "tracer/compile/simd.py",
        },
        "llvmlite": {"tracer/compile/intrinsics.py", "tracer/compile/bundle.py", "tracer/compile/simd.py"},
        "glfw": {"viewer/window/backend.py"},
        "trimesh": {"tracer/formats/meshes.py"},
        "distributed": {"tracer/image/cluster.py"},
        "fpdf": {"viewer/figures/writers/pdf.py"},
        "pypdfium2": {"viewer/figures/writers/png.py"},
        "pptx": {"viewer/figures/writers/pptx.py"},
        "contourpy": {"viewer/figures/visible/outlines.py"},
    }
    for library, home in homes.items():
        users = {str(path.relative_to(ROOT)) for path in SOURCES if library in {n.split(".")[0] for n in imports(path)}}
        assert users == home


def test_importing_the_tracer_brings_no_window_and_no_mesh_library() -> None:
    program = (
        "import sys, tracer, tracer.image.cluster\n"
        "print(sorted({'moderngl', 'glfw', 'imgui_bundle', 'trimesh', 'PIL', 'dask'} & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_help_needs_no_heavy_library() -> None:
    program = "import sys\nfrom viewer.cli import main\nmain.make_parser()\n"
    program += "print(sorted({'numpy', 'numba', 'imgui_bundle'} & set(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_file_says_what_it_is_and_stays_short(path: Path) -> None:
    text = path.read_text("utf-8")
    assert ast.get_docstring(ast.parse(text)), "no module docstring"
    assert text.count("\n") <= 330


def test_kernels_are_compiled_for_one_set_of_types() -> None:
    """However a scene was written - with whole numbers, tuples, arrays - nobody waits for a second compilation."""
    program = (
        "import tracer, numpy as np\n"
        "from tests.scenes import *\n"
        "from tracer.kernel.entry import trace_area\n"
        "world = world_of(ball((0, 0, 0), 1), lights=[Light('l', position=(1, 2, 3))], background=(1, 1, 1))\n"
        "tracer.trace(world, (3, 4)); tracer.trace(world, ray=((0, 0, 5), (0, 0, -1)), min_weight=0)\n"
        "tracer.trace(world, ray=(np.array([0, 0, 5]), [0, 0, -1.0])); tracer.trace(world, (1, 1), sample=3)\n"
        "tracer.render(world, (8, 8), samples=2, min_weight=0.5); tracer.render(world)\n"
        "print(len(trace_area.signatures))"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    assert run.stdout.strip() == "1"


def test_machine_code_is_kept_where_it_can_be_written(tmp_path: Path) -> None:
    """A home that cannot be written to is no reason to fail: the code then lives in a temporary folder."""
    program = "from tracer.compile.jit import cache_folder; print(cache_folder())"
    for home, expected in ((tmp_path, str(tmp_path)), (Path("/dev/null"), "")):
        environment = {**os.environ, "XDG_CACHE_HOME": str(home), "TMPDIR": str(tmp_path)}
        run = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=True
        )
        assert run.stdout.startswith(expected)
        assert Path(run.stdout.strip()).is_dir()
