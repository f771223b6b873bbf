"""What leaving a pass, a shader's branch or a panel out saves a frame: drawn without a screen, both ways in turn."""

from collections.abc import Sequence
from pathlib import Path

from tracer.kernel.left_out import Need
from tracer.measure.plan.paired_timing import paired, wall_seconds
from tracer.measure.plan.savings import Saving
from viewer.cli.needs import SHADER
from viewer.gl.features import features_of
from viewer.gl.stage import Stage
from viewer.lessons.lesson import Lesson, LessonView
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import NoWindow, Offscreen

SIZE = (1280, 720)
SCENE_SIZE = (480, 270)  # of the 3D view
BUDGET = 0.8  # seconds a line
FRAMES = 10  # of the panels, a time


def frame_costs(needs: Sequence[Need], path: Path, lesson: Lesson | None) -> list[Saving]:
    """A line for everything that a scene needs of the window or does without; the seconds are those of a frame."""
    try:
        surface = Offscreen(SIZE)
    except NoWindow:
        return [Saving(need, "nothing can be drawn: no OpenGL 3.3") for need in needs]
    app = App(surface, Session())
    try:
        app.session.open(path, lesson)
        app.settle()
        return [stage_cost(app, need) if need.name in SHADER else panel_cost(app, need) for need in needs]
    finally:
        app.close()


def stage_cost(app: App, need: Need) -> Saving:
    """The 3D view with and without a feature. Without what it needs, a scene has another picture; else the same."""
    session = app.session
    assert session.world
    one, own = frozenset({SHADER[need.name]}), features_of(session.world.scene)
    stages = [Stage(app.surface.ctx) for _ in range(2)]
    for stage, features in zip(stages, (own - one, own | one), strict=True):
        stage.set_world(session.world, session.frame, features)

    def draw(stage: Stage) -> None:
        stage.draw(session.orbit, session.theme, SCENE_SIZE, app.surface.scale, None)
        stage.target.pixels()  # waits until all is drawn

    turns = paired(*(lambda stage=stage: wall_seconds(lambda: draw(stage)) for stage in stages), budget=BUDGET)
    for stage in stages:
        stage.release()
    return Saving(need, f"the 3D view, {SCENE_SIZE[0]}x{SCENE_SIZE[1]}", turns)


def panel_cost(app: App, need: Need) -> Saving:
    """The whole window with a lesson's panel behind the numbers and without one."""
    session = app.session
    shown = session.lesson or Lesson("", "", Path(), "", None, None, LessonView())

    def drawing(lesson: Lesson | None) -> float:
        session.lesson, session.wants_numbers = lesson, True
        app.frame()
        app.frame()
        return wall_seconds(lambda: [app.frame() for _ in range(FRAMES)]) / FRAMES

    turns = paired(lambda: drawing(None), lambda: drawing(shown), BUDGET)
    return Saving(need, "all panels, this one not in front", turns)
