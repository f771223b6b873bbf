"""A recorded run of the recursion in `tracer.whitted` for the ray of a tree: each line that runs, with all calls that
are active and the values of their variables.

The run is traced with `sys.settrace`, line by line in `radiance` and not in the functions that it calls. Its calls are
compared with the rows of the tree: a record ends where they differ, since the page has an epsilon and does not know
overlapping solids, and where the run becomes too long. It says so then.
"""

import ast
import inspect
import math
import sys
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property
from types import FrameType
from typing import Any

import numpy as np

from tracer import whitted
from tracer.formulas.vector import Vector, vector
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree

MOST_CALLS = 400  # of `radiance`
MOST_TESTS = 100_000  # of a ray with a surface: two or three seconds
SAME = 1e-6  # directions, factors and points (relative to their distance) may differ by rounding, and by no more


@dataclass(frozen=True)
class Values:
    """The variables of one call, as far as they have values."""

    depth: int
    n1: float
    color: Vector | None = None
    kr: float | None = None
    kt: float | None = None


@dataclass(frozen=True)
class Call:
    """A call of `radiance`, which follows one ray."""

    row: int  # of the ray in the tree
    caller: int  # the number of the call that made it; -1 for the first
    moment: int  # the number of the moment at which it was made


@dataclass(frozen=True)
class Moment:
    """A line that runs. Its variables have the values from before it."""

    call: int
    line: int  # the first line of the statement, in the file
    values: Values
    row: int  # the row that was revealed last, or (`sums`) whose radiance was summed up last
    sums: bool


@dataclass(frozen=True, eq=False)
class Recording:
    """The calls in the order of the recursion, and the moments of the run."""

    tree: RayTree
    calls: list[Call]
    moments: list[Moment]
    note: str = ""  # the reason why it ends early

    def stack(self, k: int) -> list[tuple[Call, Values]]:
        """The active calls at moment k, the first call first. Each waiting call has its values from when it called."""
        found = []
        while k >= 0:
            moment = self.moments[k]
            call = self.calls[moment.call]
            found.append((call, moment.values))
            k = call.moment
        return found[::-1]

    @cached_property
    def _firsts(self) -> dict[tuple[int, bool], int]:
        """The first moment at which a row is the last one that was revealed, or summed up."""
        found: dict[tuple[int, bool], int] = {}
        for k, moment in enumerate(self.moments):
            found.setdefault((moment.row, moment.sums), k)
        return found

    def find(self, row: int, sums: bool) -> int | None:
        """The moment at which a row is revealed, or summed up; None if the record ends before."""
        return self._firsts.get((row, sums))


@dataclass(frozen=True)
class Statement:
    """A statement of `radiance`: its first and last line in the file. Of an `if`, only the condition."""

    first: int
    last: int


@dataclass(frozen=True)
class Source:
    """The text of `radiance`."""

    lines: list[str]  # without its docstring, the first is the one that defines it
    numbers: list[int]  # of these lines in the file
    statements: list[Statement]
    traces: int  # the line that follows the ray to its hit
    lights: int  # the line that sends the shadow rays

    def statement(self, line: int) -> Statement:
        return next(statement for statement in self.statements if statement.first <= line <= statement.last)


@cache
def source() -> Source:
    """The text of `radiance`, from the file that runs."""
    text, start = inspect.getsourcelines(whitted.radiance)
    function = ast.parse(textwrap.dedent("".join(text))).body[0]
    assert isinstance(function, ast.FunctionDef)
    docstring, *body = function.body
    hidden = range(docstring.lineno, (docstring.end_lineno or 0) + 1)
    shown = [k for k in range(1, len(text) + 1) if k not in hidden]
    found: list[Statement] = []
    lines: dict[str, int] = {}
    for node in (each for statement in body for each in ast.walk(statement)):
        if isinstance(node, ast.stmt):
            end = node.test.end_lineno if isinstance(node, ast.If) else node.end_lineno
            found.append(Statement(node.lineno + start - 1, (end or node.lineno) + start - 1))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            lines.setdefault(node.func.id, node.lineno + start - 1)
    return Source(
        [text[k - 1].rstrip("\n") for k in shown],
        [k + start - 1 for k in shown],
        sorted(found, key=lambda statement: statement.first),
        lines[whitted.first_hit.__name__],
        lines[whitted.local_light.__name__],
    )


class _Ended(Exception):
    """The run ends early. The text says why."""


def record(tree: RayTree, is_wanted: Callable[[], bool] = lambda: True) -> Recording:
    """Run `radiance` for the ray of this tree, and record it. It ends early when it `is_wanted` no more."""
    return _Recorder(tree, is_wanted).run()


class _Recorder:
    def __init__(self, tree: RayTree, is_wanted: Callable[[], bool]) -> None:
        self.tree, self.is_wanted = tree, is_wanted
        self.source = source()
        self.calls: list[Call] = []
        self.moments: list[Moment] = []
        self.active: list[int] = []  # numbers of calls
        self.coming: list[list[int]] = []  # for each active call, the rows of the rays that it has yet to follow
        self.shown = (0, False)
        self.tests = 0

    def run(self) -> Recording:
        tree, first = self.tree, self.tree.nodes[0]
        tracing = replace(tree.scene.tracing, model=tree.model)
        world = replace(tree.world, scene=replace(tree.scene, tracing=tracing))
        n1 = 1.0 if math.isnan(first["n1"]) else float(first["n1"])
        note, before = "", sys.gettrace()
        sys.settrace(self._enter)
        try:
            with np.errstate(all="ignore"):
                whitted.radiance(world, vector(first["origin"]), vector(first["direction"]), tree.depth, n1)
        except _Ended as ended:
            note = str(ended)
        finally:
            sys.settrace(before)
        return Recording(tree, self.calls, self.moments, note)

    def _enter(self, frame: FrameType, event: str, argument: object) -> Any:
        """A function is called: `radiance` is traced line by line, and the work of `closest_hit` is counted."""
        if frame.f_code is whitted.closest_hit.__code__:
            self.tests += len(self.tree.world.arrays.surfaces)
            if not self.is_wanted():
                raise _Ended("stopped")
            if self.tests > MOST_TESTS:
                raise _Ended(f"The record ends here: more than {MOST_TESTS:,} tests of a ray with a surface.")
        if frame.f_code is not whitted.radiance.__code__:
            return None
        if len(self.calls) == MOST_CALLS:
            raise _Ended(f"The record ends here, after {MOST_CALLS} calls.")
        row = 0
        if self.active:
            row = self._row(frame)
            self.calls.append(Call(row, self.active[-1], len(self.moments) - 1))
        else:
            self.calls.append(Call(row, -1, -1))
        self.active.append(len(self.calls) - 1)
        self.coming.append([c for c in self.tree.children[row] if self.tree.nodes["kind"][c] != SHADOW])
        return self._line

    def _row(self, frame: FrameType) -> int:
        """The row of the ray that a call follows, by the order of the recursion."""
        caller = self.calls[self.active[-1]].row
        assert frame.f_back
        if not self.coming[-1]:
            raise self._differs(caller, "the kernel sends no such ray")
        row, arguments, callers = self.coming[-1].pop(0), frame.f_locals, frame.f_back.f_locals
        node = self.tree.nodes[row]
        factor = callers["kt" if self.tree.kind(row) == "refraction" else "kr"]
        if not _same(arguments["v"], node["direction"]) or not _same(factor, node["factor"]):
            raise self._differs(row, "another ray is sent")
        return row

    def _line(self, frame: FrameType, event: str, argument: Any) -> Any:
        row = self.calls[self.active[-1]].row
        if event == "line":
            self._moment(frame, row)
        elif event == "return":
            self._return(row, argument)
        return self._line

    def _moment(self, frame: FrameType, row: int) -> None:
        call, line = self.active[-1], self.source.statement(frame.f_lineno).first
        last = self.moments[-1] if self.moments else None
        if last and last.call == call and last.line == line:
            return  # a further line of the same statement
        if last and last.call == call and last.line == self.source.traces:
            self._compare_hit(row, frame.f_locals["hit"])
        if line == self.source.traces:
            self.shown = (row, False)
        elif line == self.source.lights:
            lights = [c for c in self.tree.children[row] if self.tree.nodes["kind"][c] == SHADOW]
            self.shown = (lights[0], False) if lights else self.shown
        found = frame.f_locals
        values = Values(found["depth"], found["n1"], found.get("color"), found.get("kr"), found.get("kt"))
        self.moments.append(Moment(call, line, values, *self.shown))

    def _return(self, row: int, color: Vector) -> None:
        """The last line of a call has run: its result is known, so the moment of this line shows it."""
        node = self.tree.nodes[row]
        if self.coming[-1]:
            raise self._differs(self.coming[-1][0], "this ray is not sent")
        if not np.all(np.abs(np.subtract(color, node["radiance"])) <= SAME * max(1.0, *node["radiance"])):
            raise self._differs(row, "it has another colour")
        self.active.pop()
        self.coming.pop()
        self.shown = (row, True)
        last = self.moments[-1]
        self.moments[-1] = replace(last, values=replace(last.values, color=color), row=row, sums=True)

    def _compare_hit(self, row: int, hit: whitted.Hit | None) -> None:
        node = self.tree.nodes[row]
        if (hit is None) != (node["object"] < 0):
            raise self._differs(row, "it meets something else")
        if hit and math.dist(hit.point, node["point"]) > SAME * max(float(node["t"]), *np.abs(node["point"])):
            raise self._differs(row, "it meets something else")

    def _differs(self, row: int, how: str) -> _Ended:
        return _Ended(
            f"The record ends here. At {self.tree.label(row)}, whitted.py differs from the kernel: {how}. "
            f"It has an epsilon of {whitted.EPSILON:g}, and knows no overlapping solids."
        )


def _same(a: float | Vector, b: np.ndarray) -> bool:
    return bool(np.all(np.abs(np.subtract(a, b)) <= SAME))
