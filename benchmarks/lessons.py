"""Time for a shipped lesson's image against POV-Ray's: 640x480, depth 3, Whitted's model, nothing cut."""

import dataclasses

import tracer
from benchmarks.race import Race, need_povray
from benchmarks.results.figure import Figure, compared
from benchmarks.results.task import Options, Task
from tests import povray
from viewer.lessons import lesson

SIZE = (640, 480)
DEPTH = 3
UNSEEN = ("scale", "panes")  # smaller than POV-Ray's epsilon


def times(options: Options) -> list[Task]:
    def race(name: str) -> list[Figure]:
        need_povray()
        scene = tracer.load(lesson.read(name).scene)
        scene = dataclasses.replace(scene, tracing=dataclasses.replace(scene.tracing, model="whitted", depth=DEPTH))
        ours, theirs = Race(scene, povray.write_scene(scene, DEPTH, SIZE), SIZE, DEPTH).times(options.runs)
        return [compared("lessons", name, "s", ours, "POV-Ray", theirs, faster=True)]

    names = [name for name in lesson.names() if name not in UNSEEN]
    return [Task(name, 1.0 + 0.8 * (options.runs + 1), lambda name=name: race(name)) for name in names]
