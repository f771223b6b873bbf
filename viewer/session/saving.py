"""Saving and copying what is on show: the figure, its command line, the image."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from viewer.base.clipboard import copy_to_clipboard
from viewer.base.files import Unusable, free_path
from viewer.base.pictures import write_picture
from viewer.base.theme import PANEL_TEXT
from viewer.figures.catalogue import ORDERS, STEPS
from viewer.figures.export_options import ExportOptions
from viewer.lessons.step_text import step_text
from viewer.reopen.view_state import UNCHANGED, differing
from viewer.session.figure_export import Shown
from viewer.session.lecture.copied import step_of_view
from viewer.session.restore.command import scene_word, view_command
from viewer.session.restore.figure_scene import save_copy
from viewer.session.restore.view import restore_camera, state_of
from viewer.session.session import Session


def export_figure(session: Session, copied: bool = False) -> None:
    """Write the figure on show into the current folder, or copy it."""
    tree = session.tree
    if not tree or not session.world or not session.opening:
        session.notice.say("nothing to export yet: pick a pixel")
        return
    lesson, opening = session.lesson, session.opening
    figure = session.export.figure or session.layout.pointed or "both"
    step = session.step if figure != "hit" else None  # a hit has no steps
    options = ExportOptions(
        scene=scene_word(opening.path, lesson, opening.figure),
        at=session.at,
        swept=session.swept,
        pixel=None if session.between else session.pixel,
        ray=(*ray[0], *ray[1]) if (ray := session.ray) else None,
        sample=tree.sample or None,
        figure=figure,
        view=session.orbit.view(session.frame) if figure in ("both", "scene") else None,
        node=tree.path(session.selected) if figure == "hit" and session.selected is not None else None,
        turn=session.turn if figure == "hit" else None,
        depth=range(session.depth, session.depth + 1),
        step=session.reveal.granularity if step else STEPS[0],
        order=session.reveal.order if step else ORDERS[0],
        page=session.reveal.position if step else None,
        model=session.model,
        filter=session.shown.filter,
        **_as_on_show(session, figure),
        up=session.up,
        output=".",
    )
    state = state_of(session)
    restore_camera(session, state)  # the view that the figure opens, which may differ by rounding
    more = differing(state, options.state(session.size))
    options = replace(options, reopen=more if more != UNCHANGED else None)
    name, angles = (lesson.name, opening.step.state.view) if lesson and opening.step else (opening.path.stem, None)
    part = step.name if step else ""
    shown = Shown(options, session.appearance.theme.name, session.world, name, angles, opening.files, part)
    session.export.start(shown, copied, session.notice.say, session.show_faults)


def _as_on_show(session: Session, figure: str) -> dict[str, Any]:
    """The options with which a figure is the one in its panel."""
    paper = session.layout.papers.get(figure)
    found: dict[str, Any] = {"paper": paper, "text_size": PANEL_TEXT} if paper else {}
    if figure != "hit":
        found["select"] = session.selection if session.selected is not None else None
    if figure in ("tree", "both"):
        found["swatches"] = True
    if figure == "tree":
        found["levels"] = True
    return found


def copy_command(session: Session) -> None:
    """Copy the command line of the last figure."""
    if not session.export.command:
        session.notice.say("no command line to copy yet: export a figure first")
        return
    try:
        copy_to_clipboard(session.export.command)
        session.notice.say("the figure's command line is copied")
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))


def copy_view(session: Session, size: tuple[int, int]) -> None:
    """Copy the command line that opens an equal window. `size` is that of this one."""
    opening = session.opening
    if not opening:
        session.notice.say("nothing to copy yet: no scene is on show")
        return
    try:
        language = opening.lesson.language if opening.lesson else ""
        word = scene_word(opening.path, opening.lesson, opening.figure)
        copy_to_clipboard(view_command(session, word, size, language))
        session.notice.say("the command line of this view is copied")
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))


def copy_step(session: Session) -> None:
    """Copy the view on show as a step of a lesson."""
    if not session.opening:
        session.notice.say("nothing to copy yet: no scene is on show")
        return
    try:
        copy_to_clipboard(step_text(step_of_view(session)))
        session.notice.say("the view is copied as a step of a lesson: paste it below a heading")
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))


def save_scene(session: Session) -> None:
    """Write the copy of a scene that a figure carried into a new folder, and open it there."""
    opening = session.opening
    if not opening or not opening.figure or not opening.files:
        session.notice.say("this scene is no copy: it is a file already")
        return
    try:
        path = save_copy(opening.path, opening.files)
        session.notice.say(f"wrote {path}")
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))


def save_image(session: Session) -> None:
    """Write the image on show into the current folder, under a name that does not exist."""
    picture = session.image.picture
    if not picture or not session.path:
        return
    name = session.lesson.name if session.lesson else session.path.stem
    path = free_path(Path(f"{name}.png"))
    try:
        write_picture(path, picture.shown[..., :3])
        session.notice.say(f"wrote {path.resolve()}" + ("" if picture.finished else " (not finished yet)"))
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))
