"""What the stable formulas cost: images with them against images with the textbook's in the same kernel.

`make bench-stable`.

The plain kernel has the quadratic by (-b -+ sqrt(b^2 - ac)) / a, planes by one division, the hit where the ray says,
directions by a root and three divisions. It is compiled in a process of its own; both take turns, one thread each.
"""

import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import tracer
from tracer import branch, digits, hits, interface, kernel, shapes
from tracer.jit import compiled
from tracer.rays import Ray
from tracer.render import warm
from tracer.shapes import planar, polygon, sphere, triangle
from tracer.shapes import plane as plane_shape
from tracer.vector import Vector, add, dot, scale, subtract, unit, vector
from viewer import lesson

SIZE = (640, 480)
RUNS = 9


@compiled
def plain_sphere(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    f = subtract(ray.origin, vector(surface.a))
    a, b, c = dot(ray.direction, ray.direction), dot(f, ray.direction), dot(f, f) - surface.r * surface.r
    discriminant = b * b - a * c
    if discriminant < 0.0:
        return math.inf
    near, far = (-b - math.sqrt(discriminant)) / a, (-b + math.sqrt(discriminant)) / a
    if near > 0.0 and near >= floor:
        return near
    return far if far > 0.0 and far >= floor else math.inf


@compiled
def plain_on_sphere(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    p = add(ray.origin, scale(t, ray.direction))
    n = scale(1.0 / surface.r, subtract(p, vector(surface.a)))
    return (p, n, n)


@compiled
def plain_plane(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    n = vector(surface.normal)
    t = dot(n, subtract(vector(surface.a), ray.origin)) / dot(n, ray.direction)
    return t if t > 0.0 and floor <= t <= ceiling else math.inf


@compiled
def plain_on_plane(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    n = vector(surface.normal)
    return (add(ray.origin, scale(t, ray.direction)), n, n)


@compiled
def plain_mirrored(v: Vector, n: Vector) -> Vector:
    return unit(subtract(v, scale(2.0 * dot(n, v), n)))


@compiled
def plain_sine(v: Vector, n: Vector) -> float:
    c1 = dot(v, n)
    return math.sqrt(max(0.0, 1.0 - c1 * c1))


def make_plain() -> None:
    """Put the textbook's formulas where kernels will look them up; nothing is compiled yet."""
    sphere.intersect, sphere.locate = plain_sphere, plain_on_sphere
    for flat in (plane_shape, polygon, triangle):
        vars(flat)["plane_distance"] = plain_plane
    plane_shape.locate = polygon.locate = planar.locate = plain_on_plane
    intersect = shapes._fold("intersect", shapes._no_intersect, shapes._link_intersect)
    locate = shapes._fold("locate", shapes._no_locate, shapes._link_locate)
    hits.intersect = intersect
    interface.locate = kernel.locate = digits.locate = locate
    branch.mirrored = kernel.mirrored = plain_mirrored
    branch.sine = kernel.sine = plain_sine


def times() -> dict[str, float]:
    """Seconds for each lesson's image, at its own depth."""
    warm()
    found = {}
    for name in lesson.names():
        world = tracer.prepare(tracer.load(lesson.read(name).scene))
        found[name] = min(tracer.render(world, SIZE, threads=1).seconds["trace"] for _ in range(3))
    return found


def main() -> int:
    if sys.argv[1:] == ["--plain"]:
        make_plain()
    if sys.argv[1:]:
        print(json.dumps(times()))
        return 0
    ratios: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for run in range(RUNS + 1):
            plain, ours = (seconds(kind, folder) for kind in ("--plain", "--stable"))
            if run:  # the first of each compiles
                for name, value in ours.items():
                    ratios.setdefault(name, []).append(value / plain[name])
    print(f"{SIZE[0]}x{SIZE[1]}, one thread, our time over that with plain formulas, median of {RUNS} runs in turn")
    for name, found in ratios.items():
        print(f"{name:14} {statistics.median(found):.2f}   {min(found):.2f} .. {max(found):.2f}")
    return 0


def seconds(kind: str, folder: str) -> dict[str, float]:
    environment = {**os.environ, "XDG_CACHE_HOME": str(Path(folder) / kind)}
    command = [sys.executable, "-m", "benchmarks.against_textbook", kind]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout)


if __name__ == "__main__":
    sys.exit(main())
