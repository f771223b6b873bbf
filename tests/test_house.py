"""Rules for the source tree: order of packages, no import cycles, homes of libraries, sizes of files."""

import ast
import os
import re
import subprocess
import sys
from collections import Counter
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from tests import ROOT

# Each package may import from itself and from the packages after it. `raytree`, `viewer` and `tracer` share one list.
ORDER = (
    "raytree",
    "viewer.cli", "viewer.report", "viewer.window", "viewer.panels", "viewer.gl", "viewer.session", "viewer.handout",
    "viewer.lessons", "viewer.figures", "viewer.reopen", "viewer.explain", "viewer.base",
    "tracer", "tracer.optics", "tracer.nodes", "tracer.cluster",  # the public modules
    "tracer.whitted", "tracer.measure", "tracer.image", "tracer.tree", "tracer.kernel", "tracer.formats",
    "tracer.scene", "tracer.accel", "tracer.shapes", "tracer.fields", "tracer.rays", "tracer.formulas",
    "tracer.compile", "tracer.processes", "tracer.printable", "tracer.choices", "tracer.extras", "tracer.progress",
)  # fmt: skip
PUBLIC = ("tracer", "tracer.optics", "tracer.nodes", "tracer.cluster")

SOURCES = [path for top in ("raytree", "tracer", "viewer") for path in sorted((ROOT / top).rglob("*.py"))]
REFERENCE = re.compile(r"((?:raytree|tracer|viewer)(?:\.\w+)+):[\w.]+")  # "module:function", imported on first use
MAX_FILES = 16  # in a folder
MAX_LINES = 300


def module(path: Path) -> str:
    """The module name of a file."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


NAMES = {module(path): path for path in SOURCES}


def package(name: str) -> str:
    """The package of a module in ORDER."""
    found = [p for p in ORDER if name == p or (p != "tracer" and name.startswith(f"{p}."))]
    assert found, f"{name} is in no package of ORDER"
    return max(found, key=len)


def imports(path: Path, references: bool = False) -> set[str]:
    """All modules that a file imports, also inside functions and for type checking; with `references` also those named
    in strings.
    """
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            whole = {f"{node.module}.{name.name}" for name in node.names}
            found |= {name if name in NAMES else node.module for name in whole}
        elif references and isinstance(node, ast.Constant) and isinstance(node.value, str):
            found |= set(REFERENCE.findall(node.value))
    return found


def test_packages_import_only_from_packages_after_them_in_the_order() -> None:
    wrong = []
    for name, path in NAMES.items():
        if name in ("viewer", *PUBLIC):
            continue
        for other in imports(path, references=True) & set(NAMES):
            if other in PUBLIC and name.startswith("tracer."):
                wrong.append(f"{name} imports the public {other}, not the module behind it")
            elif ORDER.index(package(other)) < ORDER.index(package(name)):
                wrong.append(f"{name} imports {other}")
    assert not wrong


def test_no_import_cycles() -> None:
    """The import graph has no cycle; graphlib raises CycleError if it has one."""
    graph = {name: (imports(path) & set(NAMES)) - {name} for name, path in NAMES.items()}
    assert len(list(TopologicalSorter(graph).static_order())) == len(NAMES)


def test_a_folder_has_few_files() -> None:
    files = [*SOURCES, *(ROOT / "benchmarks").rglob("*.py")]
    counts = Counter(path.parent for path in files if path.name != "__init__.py")
    assert {str(folder.relative_to(ROOT)): n for folder, n in counts.items() if n > MAX_FILES} == {}


def test_tracer_never_imports_the_viewer_nor_its_libraries() -> None:
    for path in SOURCES:
        if path.is_relative_to(ROOT / "tracer"):
            tops = {name.split(".")[0] for name in imports(path)}
            assert not tops & {"viewer", "moderngl", "glfw", "imgui_bundle", "PIL", "shaders", "lessons"}, path


def test_one_place_knows_each_library() -> None:
    homes = {
        "numba": {f"tracer/compile/{name}.py" for name in ("jit", "numba_private", "intrinsics", "bundle", "simd")},
        "llvmlite": {f"tracer/compile/{name}.py" for name in ("intrinsics", "bundle", "simd")},
        "glfw": {"viewer/window/backend.py", "viewer/window/second.py"},
        "trimesh": set(),
        "mapbox_earcut": {
            "tracer/shapes/polygon.py",
            "tracer/formats/polygons.py",
            "viewer/figures/writers/imgui.py",
        },
        "distributed": {"tracer/image/cluster.py"},
        "fpdf": {"viewer/figures/writers/pdf.py"},
        "pypdfium2": {"viewer/base/pdfium.py"},
        "ziamath": {"viewer/figures/formula/ziamath_paths.py"},
        "pptx": {
            "viewer/figures/writers/pptx.py",
            "viewer/figures/writers/pptx_file.py",
            "viewer/figures/writers/pptx_shapes.py",
            "viewer/handout/pptx.py",
        },
        "contourpy": {"viewer/figures/visible/outlines.py"},
        "copykitten": {"viewer/base/clipboard.py"},
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
    assert text.count("\n") <= MAX_LINES


def test_kernels_are_compiled_for_one_set_of_types() -> None:
    """One compilation serves a scene whether its numbers are written as int, as tuples or as arrays."""
    program = (
        "import tracer, numpy as np\n"
        "from tests.scenes import *\n"
        "from tracer.kernel.entry import trace_pixels\n"
        "world = world_of(ball((0, 0, 0), 1), lights=[Light('l', position=(1, 2, 3))], background=(1, 1, 1))\n"
        "tracer.trace(world, (3, 4)); tracer.trace(world, ray=((0, 0, 5), (0, 0, -1)), min_weight=0)\n"
        "tracer.trace(world, ray=(np.array([0, 0, 5]), [0, 0, -1.0])); tracer.trace(world, (1, 1), sample=3)\n"
        "tracer.render(world, (8, 8), samples=2, min_weight=0.5); tracer.render(world)\n"
        "print(len(trace_pixels.signatures))"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    assert run.stdout.strip() == "1"


def test_machine_code_is_kept_where_it_can_be_written(tmp_path: Path) -> None:
    """If the cache folder cannot be written to, compiled code is kept in a temporary folder instead."""
    program = "from tracer.compile.kernel_cache import cache_folder; print(cache_folder())"
    for home, expected in ((tmp_path, str(tmp_path)), (Path("/dev/null"), str(tmp_path / "raytree-"))):
        environment = {**os.environ, "XDG_CACHE_HOME": str(home), "TMPDIR": str(tmp_path)}
        run = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=True
        )
        assert run.stdout.startswith(expected)
        assert Path(run.stdout.strip()).is_dir()
