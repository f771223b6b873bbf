"""The figures of a lesson, one for each picture and stage, with names that sort as the lesson goes."""

from collections.abc import Iterator

from viewer.base.theme import Theme
from viewer.figures.marks import CANVAS, Figure, Handle
from viewer.handout.document import Handout, Page, Room, Show

TEXT = 18.0  # points, on a slide


def figures_of(handout: Handout, command: str, theme: Theme) -> Iterator[tuple[str, Figure]]:
    """(name of the file without its suffix, figure) for all pictures.

    Names are like critical-angle_2.1_tree: the step, and the presses after its beginning, as in `--at 2.1`. Positions
    of a sweep or of a handle are left out.
    """
    digits = len(str(len(handout.pages)))
    for page in handout.pages:
        for show, moments in _moments(page):
            drawn = [picture.draw(Room(CANVAS, TEXT, theme), range(len(moments))) for picture in show.pictures]
            for k, press in enumerate(moments):
                for picture, frames in zip(show.pictures, drawn, strict=True):
                    kept = tuple(mark for mark in frames[k] if not isinstance(mark, Handle))
                    title = f"{handout.lesson.name}: {page.title}, {picture.title.lower()}"
                    stem = f"{handout.lesson.name}_{page.number:0{digits}}.{press}_{picture.kind}"
                    if kept:
                        yield stem, Figure(title, picture.says(k, kept), command, kept, theme.ground)


def _moments(page: Page) -> Iterator[tuple[Show, list[str]]]:
    """The shows of a step and of its live pieces, each with the presses at which its frames appear."""
    first = page.stages - 1
    digits = len(str(first + len(page.parts) - 1))
    yield page.show, [f"{stage:0{digits}}" for stage in range(page.stages)]
    for k, part in enumerate(page.parts):
        yield from ((show, [f"{first + k:0{digits}}"]) for show in part.live.values())
