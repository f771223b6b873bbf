"""The view on show as a step of a lesson."""

from dataclasses import replace

from viewer.lessons.step import MOST_PANELS, LessonView, State
from viewer.reopen.view_state import KINDS
from viewer.session.layout import LESSON
from viewer.session.restore.view import restore_camera, state_of
from viewer.session.session import Session

DIGITS = 4  # of the 3D view: more would only be noise in the text


def step_of_view(session: Session) -> State:
    """The state that leads back to what is on show. The 3D view is set to its rounded numbers: then both are equal."""
    assert session.opening
    now = state_of(session)
    camera = tuple(float(f"{number:.{DIGITS}g}") for number in session.orbit.view(session.frame))
    restore_camera(session, replace(now, camera=camera))
    azimuth, elevation, distance, x, y, z = camera
    step = session.lesson_step
    shown = now.beside or now.panels or session.layout.shown(session.appearance.is_lecture_size)
    return State(
        scene=step.state.scene if step else session.opening.path.name,
        set=session.opening.changes,
        pixel=now.pixel,
        sample=session.sample.number(session.world.scene) if session.world else None,
        depth=now.depth,
        model=now.model,
        show=KINDS if now.filter is None else now.filter,
        view=LessonView(azimuth, elevation, distance, (x, y, z), session.inset),
        panels=tuple(name for name in shown if name != LESSON)[:MOST_PANELS] or ("scene",),
        hit=now.select,
    )
