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
        found = []
        for show, moments in _moments(page):
            for picture in show.pictures:
                drawn = picture.draw(Room(CANVAS, TEXT, theme), list(moments.values()))
                title = f"{handout.lesson.name}: {page.title}, {picture.title.lower()}"
                for (press, frame), marks in zip(moments.items(), drawn, strict=True):
                    kept = tuple(mark for mark in marks if not isinstance(mark, Handle))
                    figure = Figure(title, picture.says(frame, kept), command, kept, theme.ground)
                    found.append(
                        (press, f"{handout.lesson.name}_{page.number:0{digits}}.{press}_{picture.kind}", figure)
                    )
        yield from ((stem, figure) for _, stem, figure in sorted(found, key=lambda one: one[0]) if figure.marks)


def _moments(page: Page) -> Iterator[tuple[Show, dict[str, int]]]:
    """The shows of a step and of its live pieces, each with its frames by the presses at which they appear."""
    first = len(page.stages) - 1
    digits = len(str(first + len(page.parts) - 1))
    yield page.show, {f"{press:0{digits}}": frame for press, frame in enumerate(page.stages)}
    for k, part in enumerate(page.parts):
        yield from ((show, {f"{first + k if k else 0:0{digits}}": 0}) for show in part.live.values())
