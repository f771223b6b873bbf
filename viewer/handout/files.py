"""The files of `raytree export LESSON --lesson`: one document for each format that has pages of text, and a folder of
figures.
"""

from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from pkgutil import resolve_name

from viewer.base.files import Unusable
from viewer.base.options import flag
from viewer.figures.catalogue import DATA, FORMATS
from viewer.figures.export import Made, command_line
from viewer.figures.export_options import ExportOptions
from viewer.figures.targets import Target
from viewer.figures.writers.png import PIXELS
from viewer.handout.document import Handout, paper
from viewer.handout.figures import figures_of

# Functions of (Handout, command, name of a theme) that return a document with the text.
DOCUMENTS = {
    "html": "viewer.handout.html.page:write_page",
    "pptx": "viewer.handout.pptx:write_slides",
    "pdf": "viewer.handout.pdf:write_slides",
}
ALL = ("html", "pptx", "pdf", "svg")  # written into a folder if no format is asked for
ALLOWED = ("scene", "lesson", "language", "format", "theme", "width", "output")  # options


def check_lesson_options(options: ExportOptions) -> None:
    """Unusable if an option has no meaning for a lesson: each step says what its figures show."""
    given = [item.name for item in fields(options) if getattr(options, item.name) != item.default]
    wrong = [flag(name) for name in given if name not in ALLOWED]
    faults = [f"raytree export: --lesson has the figures of the steps: {' '.join(wrong)} cannot be given"] * bool(wrong)
    data = [name for name in options.format if name in DATA]
    if data:
        allowed = ", ".join(name for name in FORMATS if name not in DATA)
        faults.append(f"raytree export: --format must be of {allowed} with --lesson, got {','.join(data)}")
    if faults:
        raise Unusable(*faults)


def lesson_target(options: ExportOptions, target: Target) -> Target:
    """The target with the formats to write. Unusable for figures that are not to go into a folder."""
    formats = target.formats if options.format or not target.is_folder else ALL
    loose = [name for name in formats if name not in DOCUMENTS]
    if not target.is_folder and loose:
        raise Unusable(f"{target.path}: a lesson has many figures: name a folder, or a file of {', '.join(DOCUMENTS)}")
    return replace(target, formats=formats)


def make_lesson(
    options: ExportOptions, handout: Handout, target: Target, progress: Callable[[float], None] = lambda share: None
) -> Made:
    """Make the files of a lesson. Unusable if a format needs an extra that is not installed."""
    files: list[tuple[Path, bytes]] = []
    notes: list[str] = []
    name = handout.lesson.name
    options = replace(options, language=handout.lesson.language or options.language)  # also if the system chose it
    for k, kind in enumerate(target.formats):
        progress(k / len(target.formats))
        command = command_line(options, kind)
        if kind in DOCUMENTS:
            try:
                content = resolve_name(DOCUMENTS[kind])(handout, command, options.theme)
            except Unusable as unusable:
                if options.format or not target.is_folder:
                    raise
                notes += [f"no {FORMATS[kind].title}: {fault}" for fault in unusable.faults]
                continue
            files.append((target.file(name, FORMATS[kind].suffix), content))
        else:
            for stem, figure in figures_of(handout, command, paper(options.theme)):
                files.append(
                    (target.file(stem, FORMATS[kind].suffix), FORMATS[kind].write([figure], options.width or PIXELS))
                )
    return Made(files, notes)
