"""Cost of the window for the image, and of the image for the window, on a screen without a monitor.

The scene is a small sphereflake at 1600x1200: its image takes some seconds, in which hundreds of frames are drawn.
"""

import json
import subprocess
import tempfile
from pathlib import Path

from benchmarks.results.figure import Figure, Spread, compared
from benchmarks.results.task import Options, Task
from benchmarks.scenes.sphereflake import sphereflake
from tests.viewer.screen import missing
from tracer.processes import python_command

IMAGE = (1600, 1200)
FRAME_MOST = 1.3
IMAGE_MOST = 1.5
IDLE_MOST = 2.0  # % of a core


def window(options: Options) -> list[Task]:
    def measure() -> list[Figure]:
        if missing():
            raise RuntimeError(f"a screen is needed: the Debian packages {', '.join(missing())}")
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "flake.nff"
            scene.write_text(sphereflake(2, IMAGE))
            command = python_command("from benchmarks.desk import main; main()")
            command += [str(scene), str(options.runs)]
            run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise RuntimeError(run.stderr.strip()[-2000:])
        found = json.loads(run.stdout)
        busy, rest = ([1e3 * value for value in found[name]] for name in ("busy", "rest"))
        idle = [100.0 * value for value in found["idle"]]
        return [
            compared(
                "window",
                "a frame while an image renders",
                "ms",
                busy,
                "at rest",
                rest,
                wanted=FRAME_MOST,
                at_least=False,
            ),
            compared(
                "window",
                "an image in the window",
                "s",
                found["windowed"],
                "without one",
                found["alone"],
                wanted=IMAGE_MOST,
                at_least=False,
            ),
            Figure("window", "at rest", "% of a core", Spread.of(idle), wanted=IDLE_MOST, at_least=False),
        ]

    return [Task("window", 15.0 + 12.0 * options.runs, measure)]
