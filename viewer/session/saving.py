"""Saving and copying what is on show: the figure, its command line, the image."""

from dataclasses import replace
from pathlib import Path

from viewer.base.clipboard import copy_to_clipboard
from viewer.base.files import Unusable, free_path
from viewer.base.pictures import write_picture
from viewer.figures.export_options import ExportOptions
from viewer.reopen.view_state import UNCHANGED, differing
from viewer.session.figure_export import Shown
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
    figure, lesson, opening = session.export.figure, session.lesson, session.opening
    options = ExportOptions(
        scene=scene_word(opening.path, lesson, opening.figure),
        pixel=session.pixel,
        figure=figure,
        view=session.orbit.view(session.frame) if figure in ("both", "scene") else None,
        node=tree.path(session.selected) if figure == "hit" and session.selected is not None else None,
        depth=range(session.depth, session.depth + 1),
        model=session.model,
        no_lights="shadow" not in session.shown.kinds,
        up=session.up,
        output=".",
    )
    state = state_of(session)
    restore_camera(session, state)  # the view that the figure opens, which may differ by rounding
    more = differing(state, options.state(session.size))
    options = replace(options, reopen=more if more != UNCHANGED else None)
    name, angles = (lesson.name, lesson.view) if lesson else (opening.path.stem, None)
    shown = Shown(options, session.appearance.theme.name, session.world, name, angles, opening.files)
    session.export.start(shown, copied, session.notice.say, session.show_faults)


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
        copy_to_clipboard(view_command(session, scene_word(opening.path, opening.lesson, opening.figure), size))
        session.notice.say("the command line of this view is copied")
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
