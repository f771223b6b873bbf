"""The first start on a machine: the window can be used while the kernels are still being compiled."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.viewer.screen import missing, screen

pytestmark = [
    pytest.mark.early,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="X servers without a monitor are Linux's"),
]

PROGRAM = """
import json
from viewer.lessons import lesson
from viewer.window.app import App
from viewer.panels.image import waiting_lines
from viewer.session.session import Session
from viewer.session.view_state import Request
from viewer.window.backend import Window

app = App(Window("raytree", (1280, 720)), Session())
session = app.session
found = lesson.read("mirror-balls")
session.loader.open(found.scene, found)
compiles = session.warmup.compiles
frames, said = 0, set()
draw = app.frame

def frame():
    global frames
    draw()
    if not session.warmup.ready:
        session.set_depth(frames % 4)  # keys and clicks are taken meanwhile
        session.pick(frames % 800, 10)
        frames += 1
        said.add(waiting_lines(session)[0].split(":")[0])
    elif session.image.picture and session.image.picture.finished:
        session.requests.append(Request.QUIT)

app.frame = frame
app.run()
print(json.dumps({"compiles": compiles, "frames": frames, "said": sorted(said), "rows": len(session.tree)}))
app.close()
"""


def start(cache: Path) -> dict:
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache)}
    run = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, env=environment, check=True)
    return json.loads(run.stdout)


def test_window_draws_while_the_kernel_compiles_and_later_starts_load_it(tmp_path: Path) -> None:
    assert not missing(), f"this test needs the Debian packages {', '.join(missing())}"
    screen()
    first = start(tmp_path)
    assert first["compiles"]
    assert first["frames"] > 100
    assert "Compiling the kernels" in first["said"]
    assert first["rows"] >= 1
    later = start(tmp_path)
    assert not later["compiles"]
    assert "Compiling the kernels" not in later["said"]
