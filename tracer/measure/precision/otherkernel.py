"""Images by another kernel, in a process of its own: there formulas are exchanged before anything is compiled.

    python -m tracer.measure.precision.otherkernel single SCENE.pickle 240x180 0,1,2,3 FOUND.pickle

Its machine code is kept beside this program's own, in a folder that is named by the kind.
"""

import pickle
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tracer.compile.jit import cache_folder, cache_in
from tracer.image.render import Image, render
from tracer.kernel.entry import trace_area
from tracer.kernel.world import prepare
from tracer.measure.precision.plain import use
from tracer.measure.precision.precision import repeated
from tracer.scene import Scene
from tracer.tree.error_propagation import propagate_rows


def images(kind: str, scene: Scene, size: tuple[int, int], depths: Sequence[int]) -> list[tuple[Image, float]]:
    """Of each depth, the image and the least seconds; RuntimeError with what the process said where it failed."""
    with tempfile.TemporaryDirectory() as folder:
        given, found = Path(folder) / "scene.pickle", Path(folder) / "found.pickle"
        given.write_bytes(pickle.dumps(scene))
        words = [kind, str(given), f"{size[0]}x{size[1]}", ",".join(map(str, depths)), str(found)]
        ran = subprocess.run([sys.executable, "-m", __name__, *words], capture_output=True, text=True, check=False)
        if ran.returncode:
            raise RuntimeError(
                ran.stderr.strip().splitlines()[-1] if ran.stderr.strip() else f"ended with {ran.returncode}"
            )
        return pickle.loads(found.read_bytes())


def main(kind: str, given: str, size: str, depths: str, found: str) -> None:
    use(kind)
    for entry in (trace_area, propagate_rows):
        cache_in(entry, cache_folder() / kind)
    world = prepare(pickle.loads(Path(given).read_bytes()))
    width, height = map(int, size.split("x"))
    made = [repeated(lambda d=int(depth): render(world, (width, height), depth=d)) for depth in depths.split(",")]
    Path(found).write_bytes(pickle.dumps(made))


if __name__ == "__main__":
    main(*sys.argv[1:])
