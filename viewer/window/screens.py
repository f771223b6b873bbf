"""The place of a window on one or more screens. Rectangles are (x, y, width, height)."""

from collections.abc import Sequence

Rectangle = tuple[int, int, int, int]

REACHABLE = (120, 24)  # width and height of a window's upper part that must be on a screen


def overlap(a: Rectangle, b: Rectangle) -> tuple[int, int]:
    """Width and height of the common part of two rectangles; 0 in one of them if there is none."""
    width = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    height = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    return (max(0, width), max(0, height))


def is_reachable(window: Rectangle, screens: Sequence[Rectangle]) -> bool:
    """Whether enough of the window's upper part is on a screen to take hold of it with the mouse."""
    top = (window[0], window[1], window[2], REACHABLE[1])
    least = (min(REACHABLE[0], window[2]), REACHABLE[1])
    found = [overlap(top, screen) for screen in screens]
    return any(width >= least[0] and height >= least[1] for width, height in found)


def screen_of(window: Rectangle, screens: Sequence[Rectangle]) -> int:
    """The number of the screen that most of the window is on."""
    areas = [width * height for width, height in (overlap(window, screen) for screen in screens)]
    return areas.index(max(areas))
