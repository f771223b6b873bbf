"""The memory that a thread writes while it traces. Kernels allocate none."""

from typing import NamedTuple

import numpy as np

from tracer.accel.rows import STACK, StackRow
from tracer.accel.sah import MAX_STACK
from tracer.compile.bundle import bundle
from tracer.compile.rows import Bool, Float, Int64, Numbers, Row, Rows, dtype_of, zero_rows
from tracer.compile.simd import WIDTH
from tracer.formulas.camera import BATCH
from tracer.kernel.nodes import KINDS, NODE, NodeRow
from tracer.rays import HISTORY, HistoryRow

MAX_CROSSINGS = 32  # transparent surfaces on the way to a light, before the slower search is used


class Eye(NamedTuple):
    """The surroundings of a point."""

    solids: np.ndarray  # the transparent solids around it, a bit mask of int64 words (`tracer.formulas.media`)
    surfaces: np.ndarray  # ids of the surfaces that it lies exactly on


class Eyes(NamedTuple):
    """The same for n rays, many of which may start at one of m points."""

    point: np.ndarray  # (n,) the number of each ray's point
    solids: np.ndarray  # (m, words)
    surfaces: np.ndarray  # ids of the surfaces that the points lie on, one point after another
    starts: np.ndarray  # (m + 1,) the first entry of each point in `surfaces`, and the end of the last


class OpenRow(Row):
    """A ray that a best-first search has not traced yet."""

    weight: Float  # its largest component
    number: Int64  # in order of creation: of equal weights, the first is traced first
    parent: Int64
    refracted: Bool


class CrossingRow(Row):
    """A transparent surface on the way to a light."""

    t: Float
    surface: Int64


OPEN, CROSSING = dtype_of(OpenRow), dtype_of(CrossingRow)


class Space(NamedTuple):
    """The memory as kernels see it."""

    table: Rows[NodeRow]  # of the tree in progress
    solids: Numbers  # (rows, 2, words): the solids around each ray before its hit, and behind it
    eye_solids: Numbers  # (words,): the solids around the eye
    eye_surfaces: Numbers  # (n,): ids of the surfaces that the eye lies exactly on
    open: Rows[OpenRow]  # heap of a best-first search
    stack: Rows[StackRow]  # of a traversal
    near: Numbers  # distances at which the ray enters the boxes of one node
    crossed: Rows[CrossingRow]  # transparent surfaces on the way to a light
    around: Numbers  # (words,): the solids around a shadow ray, crossing by crossing
    way: Rows[HistoryRow]  # (1,): by which the hit was reached whose shadow rays are traced
    directions: Numbers  # (3, BATCH) of the next camera rays
    rays: Numbers  # traced in this call, by kind
    tests: Numbers  # (1,): ray-surface intersection tests in this call; a block of eight triangles counts as eight
    limited: Numbers  # (1,): trees in this call that the limit of rows ended
    resume: Numbers  # (1,): of the pixel at which the call returned early, the next sample
    tree: Numbers  # of the last tree: rows (-1: the table was too short), residual, 1 if the limit of rows ended it


class Workspace:
    """The memory of one thread. It grows when a tree needs more."""

    def __init__(self, eye: Eye, rows: int = 256) -> None:
        words = len(eye.solids)
        self.arrays = Space(
            table=zero_rows(rows, NODE, NodeRow),
            solids=np.zeros((rows, 2, words), np.int64),
            eye_solids=eye.solids,
            eye_surfaces=eye.surfaces,
            open=zero_rows(2 * rows, OPEN, OpenRow),
            stack=zero_rows(MAX_STACK, STACK, StackRow),
            near=np.zeros(WIDTH),
            crossed=zero_rows(MAX_CROSSINGS, CROSSING, CrossingRow),
            around=np.zeros(words, np.int64),
            way=zero_rows(1, HISTORY, HistoryRow),
            directions=np.zeros((3, BATCH)),
            rays=np.zeros(len(KINDS), np.int64),
            tests=np.zeros(1, np.int64),
            limited=np.zeros(1, np.int64),
            resume=np.zeros(1, np.int64),
            tree=np.zeros(3),
        )
        self._bundle()

    def grow(self) -> None:
        """Make the table four times as long."""
        rows = 4 * len(self.arrays.table)
        words = len(self.arrays.eye_solids)
        self.arrays = self.arrays._replace(
            table=zero_rows(rows, NODE, NodeRow),
            solids=np.zeros((rows, 2, words), np.int64),
            open=zero_rows(2 * rows, OPEN, OpenRow),
        )
        self._bundle()

    def _bundle(self) -> None:
        self.space = bundle(self.arrays, writable=True, ragged=("solids",))
