"""Stiff trees with known answers: the error of cutting them at a depth, at a ray's weight, or at a sum of weights.

Each is one ray, traced for every pixel of a small image so that it can be timed. Its exact radiance is a closed
form. Piles of plates: Stokes, Proc. R. Soc. 11, 1862. The slab: an Airy sum without interference. The drop:
Descartes' rays of all orders. The corridor and the shell are geometric series.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from decimal import localcontext
from functools import partial

import numpy as np

from tracer.formulas.vector import Vector, add
from tracer.image.render import render
from tracer.kernel.world import World, prepare
from tracer.measure.check.case import DIGITS
from tracer.measure.check.cases.plates import WHITE, pile, under_dark
from tracer.measure.check.cases.refraction import bent
from tracer.measure.check.scenes import ball, glass, world
from tracer.measure.precision.errors import NOTHING
from tracer.measure.precision.experiment import THREADS, Study
from tracer.measure.precision.precision import Reference, cuts
from tracer.scene import Camera, Material, Object
from tracer.shapes.polygon import Polygon
from tracer.tree.trace import trace

SIZE = (16, 16)  # pixels, which all trace the one ray
ANGLE = 1e-15  # degrees, of the whole image: all pixels have the same direction but for the last bit
ANY_DEPTH = 10_000
MOST = 100_000  # rays of a tree, where its weights hardly fall
KEPT = 0.9  # fraction of the light that the shell reflects
MIRRORED = 0.99  # fraction of the light that the corridor's mirrors reflect
BOUNCES = 40


@dataclass(frozen=True)
class Problem:
    name: str
    title: str
    about: str
    make: Callable[[], World]
    eye: Vector
    way: Vector
    exact: Callable[[World], float]
    depths: Sequence[int]
    weights: Sequence[float] = tuple(10.0**-k for k in range(1, 9))
    tolerances: Sequence[float] = tuple(10.0**-k for k in range(1, 13, 2))


def aimed(problem: Problem) -> World:
    """Its scene, with a camera whose pixels all look along the one ray."""
    camera = Camera(problem.eye, add(problem.eye, problem.way), (0.0, 0.3, 1.0), ANGLE)
    return prepare(replace(problem.make().scene, camera=camera))


def study_of(problem: Problem) -> Study:
    """Each way to cut the tree, compared with the closed form."""
    stage = aimed(problem)
    exact = problem.exact(stage)
    reference = Reference(np.full((SIZE[1], SIZE[0], 3), exact), f"closed form: {exact:.15g}", NOTHING)
    made = partial(partial, render, stage, SIZE, threads=THREADS, max_nodes=MOST)
    methods = cuts(made, problem.depths, problem.weights, problem.tolerances, ANY_DEPTH)
    return Study(
        problem.name, problem.title, problem.about, methods, lambda progress: reference, bounded=True, exact=True
    )


def slab_lets_through(stage: World) -> float:
    """(1 - R) / (1 + R), with the R of the recorded ray."""
    with localcontext(DIGITS):
        r = bent(trace(stage, (0, 0), size=SIZE, depth=0)).r
        return float((1 - r) / (1 + r))


def drop() -> World:
    return world(ball((0, 0, 0), 1.0, glass(4 / 3)), background=WHITE, model="fresnel")


def shell() -> World:
    return world(ball((0, 0, 0), 1.0, Material("shell", ambient=1.0, reflect=KEPT)))


def corridor() -> World:
    """Two mirrors at distance 1, 0.25 long per bounce, open at the end towards a white sky."""
    mirror = Material("mirror", reflect=MIRRORED)
    end = 0.25 * BOUNCES
    walls = [
        Object(Polygon(((0.0, y, -1.0), (end, y, -1.0), (end, y, 1.0), (0.0, y, 1.0))), mirror, f"wall at {y:g}")
        for y in (0.0, 1.0)
    ]
    return world(*walls, background=WHITE)


GRAZING = math.radians(89.9)

PROBLEMS = (
    Problem(
        "pile",
        "Three plates at normal incidence",
        "Six faces split every ray. The weight of a ray falls quickly, but not the number of rays: together, the cut "
        "rays weigh more than any one of them. The pile reflects N / (24 + N) of the light, N = 6.",
        lambda: pile(3),
        (0.1, 1000.0, 0.2),
        (0.0, -1.0, 0.0),
        lambda stage: 6 / 30,
        (1, 2, 4, 6, 8, 10, 12),
        tuple(10.0**-k for k in range(1, 6)),
        tuple(10.0**-k for k in range(1, 6)),
    ),
    Problem(
        "slab",
        "A slab at 89.9 degrees",
        "Light stays inside, and a hundredth leaves at each reflection: no ray weighs much, but thousands count.",
        under_dark,
        (0.1, 1.0 + math.cos(GRAZING), 0.2),
        (math.sin(GRAZING), -math.cos(GRAZING), 0.0),
        slab_lets_through,
        (1, 3, 10, 30, 100, 300, 1000, 3000),
    ),
    Problem(
        "drop",
        "A drop of water under a white sky",
        "All orders of the rainbow's ray together carry all the light: 1.",
        drop,
        (-2.0, 0.8, 0.0),
        (1.0, 0.0, 0.0),
        lambda stage: 1.0,
        (0, 1, 2, 3, 4, 5, 6, 8),
    ),
    Problem(
        "corridor",
        f"Along two mirrors, {BOUNCES} times back and forth",
        "One ray that hardly loses weight: a smaller depth finds no light, while a smallest weight does no harm.",
        corridor,
        (0.0, 0.5, 0.0),
        (0.25, 1.0, 0.0),
        lambda stage: MIRRORED**BOUNCES,
        (5, 10, 20, BOUNCES - 1, BOUNCES, BOUNCES + 10),
        (0.9, 0.8, 0.7, 0.6, 0.5, 0.1, 0.01),
    ),
    Problem(
        "shell",
        "Inside a shell that emits light and reflects nine tenths",
        "A geometric series with the sum 10: a cut at depth D loses 10 times 0.9^(D+1), which is also the bound.",
        shell,
        (0.1, 0.2, -0.3),
        (1.0, 2.0, 3.0),
        lambda stage: 1.0 / (1.0 - KEPT),
        (1, 3, 10, 30, 100, 300),
    ),
)
