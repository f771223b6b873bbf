"""Saving and copying what is on show: the figure, its command line, the image."""

from pathlib import Path

from viewer.base.clipboard import copy_to_clipboard
from viewer.base.files import Unusable
from viewer.base.pictures import write_picture
from viewer.figures.catalogue import ORDERS, STEPS
from viewer.figures.export_options import ExportOptions
from viewer.session.figure_export import Shown, free_path
from viewer.session.session import Session


def export_figure(session: Session, copied: bool = False) -> None:
    """Write the figure on show into the current folder, or copy it."""
    tree = session.tree
    if not tree or not session.world or not session.path:
        session.notice.say("nothing to export yet: pick a pixel")
        return
    figure, lesson = session.export.figure, session.lesson
    step = session.step if figure != "hit" else None  # a hit has no steps
    options = ExportOptions(
        scene=lesson.name if lesson else str(session.path),
        pixel=session.pixel,
        figure=figure,
        view=session.orbit.view(session.frame) if figure in ("both", "scene") else None,
        node=tree.path(session.selected or 0) if figure == "hit" else None,
        depth=range(session.depth, session.depth + 1),
        step=session.reveal.granularity if step else STEPS[0],
        order=session.reveal.order if step else ORDERS[0],
        page=session.reveal.position if step else None,
        model=session.model,
        no_lights="shadow" not in session.shown.kinds,
        up=session.up,
        output=".",
    )
    name, angles = (lesson.name, lesson.view) if lesson else (session.path.stem, None)
    shown = Shown(options, session.appearance.theme.name, session.world, name, angles, step.name if step else "")
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
