"""The figures of a lesson, one for each picture and stage, with names that sort as the lesson goes."""

from collections.abc import Iterator

from viewer.base.theme import Theme
from viewer.figures.marks import CANVAS, Figure, Handle
from viewer.handout.document import Handout, Page, Picture, Room, Show

TEXT = 18.0  # points, on a slide


def figures_of(handout: Handout, command: str, theme: Theme) -> Iterator[tuple[str, Figure]]:
    """(name of the file without its suffix, figure) for all pictures.

    Names are like critical-angle_2.1_tree: the step, and the presses after its beginning, as in `--at 2.1`. Positions
    of a sweep or of a handle are left out.
    """
    digits = len(str(len(handout.pages)))
    for page in handout.pages:
        for press, show, frame in _moments(page):
            for picture in show.pictures:
                figure = _figure(handout, page, picture, frame, command, theme)
                if figure.marks:
                    yield f"{handout.lesson.name}_{page.number:0{digits}}.{press}_{picture.kind}", figure


def _moments(page: Page) -> Iterator[tuple[str, Show, int]]:
    """(presses, show, frame) for the stages of a step and for its live pieces."""
    stages = page.stages
    last = stages - 1 + len(page.parts) - 1
    digits = len(str(last))
    for stage in range(stages):
        yield f"{stage:0{digits}}", page.show, stage
    for k, part in enumerate(page.parts):
        for show in part.live.values():
            yield f"{stages - 1 + k:0{digits}}", show, 0


def _figure(handout: Handout, page: Page, picture: Picture, frame: int, command: str, theme: Theme) -> Figure:
    (marks,) = picture.draw(Room(CANVAS, TEXT, theme), [frame])
    kept = tuple(mark for mark in marks if not isinstance(mark, Handle))
    title = f"{handout.lesson.title}: {page.title}, {picture.title.lower()}"
    return Figure(title, picture.says(frame, kept), command, kept, theme.ground)
