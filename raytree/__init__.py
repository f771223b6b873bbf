"""raytree from Python, for notebooks and scripts.

    import raytree
    world = raytree.prepare(raytree.load("scene.toml"))
    tree = raytree.trace(world, pixel=(320, 240), depth=3)

It has all names of `tracer`, with `cluster` and `__version__`; and `tree_svg(tree)`, the figure that a notebook shows.
Each is imported when it is first used: see `__init__.pyi` for the list.

In a folder with a file called `tracer.py`, Python would import that file in place of the package `tracer`. `import
raytree` notices it, and raises one ImportError that names the file.
"""

import importlib
import sys
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from typing import Any

_HOME = Path(__file__).resolve().parent.parent  # the folder that the packages of raytree are in


def _check_ours(name: str) -> None:
    """ImportError if `import NAME` gives, or has given, another module than the package beside this one."""
    loaded = sys.modules.get(name)
    spec: ModuleSpec | None = getattr(loaded, "__spec__", None) if loaded else find_spec(name)
    places = [spec.origin, *(spec.submodule_search_locations or [])] if spec else []
    found = getattr(loaded, "__file__", None) or next(filter(None, places), None)
    if found is None:
        raise ImportError(f"raytree is not installed completely: {_HOME} has no package {name}", name=name)
    ours = _HOME / name
    if Path(found).resolve() not in (ours, ours / "__init__.py"):
        raise ImportError(
            f"{found} is in the way of raytree's own package {name}: rename it, or start Python in another folder",
            name=name,
            path=found,
        )


_check_ours("tracer")

import tracer

__all__ = [*dir(tracer), "cluster", "tree_svg", "__version__"]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("raytree")
    if name == "cluster":
        return importlib.import_module("tracer.cluster")
    if name == "tree_svg":
        _check_ours("viewer")
        return importlib.import_module("viewer.figures.notebook").tree_svg
    if name in dir(tracer):
        return getattr(tracer, name)
    raise AttributeError(f"module 'raytree' has no attribute {name!r}", name=name)


def __dir__() -> list[str]:
    return __all__
