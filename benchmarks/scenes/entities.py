"""The lines of an NFF file: one function for each entity, numbers with twelve digits."""

from collections.abc import Iterable, Sequence

import numpy as np

Point = Sequence[float] | np.ndarray

SKY = (0.1, 0.35, 0.7)


def view(eye: Point, at: Point, up: Point, angle: float, size: tuple[int, int] = (512, 512)) -> str:
    """The camera and the background."""
    return (
        f"b {numbers(SKY)}\nv\nfrom {numbers(eye)}\nat {numbers(at)}\nup {numbers(up)}\n"
        f"angle {angle:.12g}\nhither 0.01\nresolution {size[0]} {size[1]}"
    )


def light(place: Point) -> str:
    return f"l {numbers(place)}"


def fill(
    color: Point, diffuse: float, mirror: float = 0.0, shine: float = 0.0, transmit: float = 0.0, ior: float = 1.0
) -> str:
    """The material of everything that follows."""
    return f"f {numbers(color)} {diffuse:.12g} {mirror:.12g} {shine:.12g} {transmit:.12g} {ior:.12g}"


def ball(center: Point, radius: float) -> str:
    return f"s {numbers(center)} {radius:.12g}"


def rod(start: Point, end: Point, radius: float) -> str:
    """A cylinder without caps."""
    return f"c {numbers(start)} {radius:.12g} {numbers(end)} {radius:.12g}"


def face(corners: Iterable[Point]) -> str:
    lines = [numbers(corner) for corner in corners]
    return "\n".join([f"p {len(lines)}", *lines])


def patch(corners: Iterable[Point], normals: Iterable[Point]) -> str:
    lines = [f"{numbers(corner)} {numbers(normal)}" for corner, normal in zip(corners, normals, strict=True)]
    return "\n".join([f"pp {len(lines)}", *lines])


def floor(half: float, height: float) -> str:
    """A horizontal square, z up."""
    return face([(half, half, height), (-half, half, height), (-half, -half, height), (half, -half, height)])


def text(lines: Iterable[str]) -> str:
    return "\n".join(lines) + "\n"


def numbers(values: Point) -> str:
    return " ".join(f"{float(value):.12g}" for value in values)
