"""`raytree plan`: what a scene needs and what is left out; measured, what leaving it out saves and the rest costs."""

import json
import math
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tracer.kernel.world import World
from tracer.measure.plan.imports import import_seconds
from tracer.measure.plan.paired_timing import PairedTimes
from tracer.measure.plan.savings import Measured, Saving, measure
from viewer.cli.needs import MODULES, start_needs, window_needs
from viewer.lessons.lesson import Lesson

HEADS = {"image": "THE IMAGE", "frame": "A FRAME OF THE WINDOW", "start": "A START"}
FORMAT = "raytree-plan/1"
WIDTH = 100  # of running text


@dataclass(frozen=True)
class Plan:
    """Lines by what they are about: an image, a frame of the window, a start of the program."""

    scene: str
    lines: dict[str, list[Saving]]
    image: Measured | None = None  # None: nothing was measured


def listed(world: World, lesson: Lesson | None) -> Plan:
    """Nothing is measured."""
    needs = {
        "image": world.needs,
        "frame": window_needs(world.scene, lesson is not None),
        "start": start_needs(world.scene),
    }
    return Plan(title(world), _sorted({part: [Saving(need, "") for need in these] for part, these in needs.items()}))


def measured(world: World, path: Path, lesson: Lesson | None, progress: Callable[[float], None]) -> Plan:
    """Every line with and without, in this run."""
    from viewer.cli.framecost import frame_costs

    image = measure(world, lambda share: progress(0.75 * share))
    progress(0.75)
    _, *loading = import_seconds(*MODULES.values())
    starts = [
        Saving(need, f"import {', '.join(MODULES[need.name])}", PairedTimes(0.0, took, 0.0, 1))
        if not math.isnan(took)
        else Saving(need, "not installed")
        for need, took in zip(start_needs(world.scene), loading, strict=True)
    ]
    progress(0.9)
    frames = frame_costs(window_needs(world.scene, lesson is not None), path, lesson)
    return Plan(title(world), _sorted({"image": image.lines, "frame": frames, "start": starts}), image)


def _sorted(lines: dict[str, list[Saving]]) -> dict[str, list[Saving]]:
    """The mesh library is the tracer's, but what it takes is a start's."""
    loaded = [line for line in lines["image"] if line.need.name == "mesh library"]
    image = [line for line in lines["image"] if line not in loaded]
    return {**lines, "image": image, "start": loaded + lines["start"]}


def title(world: World) -> str:
    return world.scene.title or str(world.scene.path)


def as_text(plan: Plan) -> str:
    """A table of what is needed and why; below it, if measured, one of what each takes."""
    lines = [plan.scene]
    width = max(len(line.need.name) for part in plan.lines.values() for line in part)
    for part, savings in plan.lines.items():
        lines += ["", HEADS[part]]
        for line in savings:
            state = "needed" if line.need.needed else "left out"
            lines.append(hanging(f"{line.need.name:{width}}  {state:8}  ", line.need.why))
    if plan.image is None:
        return "\n".join(lines) + "\n"
    return "\n".join([*lines, "", *_measured(plan, plan.image, width), "", *_verdict(plan.image)]) + "\n"


def _measured(plan: Plan, image: Measured, width: int) -> Iterator[str]:
    rays = ", ".join(f"{spaced(count)} {kind}" for kind, count in image.rays.items() if count)
    yield f"MEASURED with and without, in turn. The image: {_size(image.size)}, depth {image.depth}, one thread,"
    yield from textwrap.wrap(f"{rays} rays", WIDTH)
    for needed, head in ((False, "left out: it would add"), (True, "needed: what it takes")):
        chosen = [line for part in plan.lines.values() for line in part if line.need.needed == needed]
        if chosen:
            yield ""
            yield f"{head:{width + 9}}{'rays':>5}{'ms':>15}{'times':>8}   {'without' if needed else 'with'}"
            yield from (_row(line, image, width) for line in chosen)
        if any(line.turns and line.turns.tells and line.turns.extra < 0.0 for line in chosen):
            yield f"{'':{width}}  (with a minus: what it saves)"


def _row(line: Saving, image: Measured, width: int) -> str:
    note = line.how
    if line.size not in (None, image.size):
        note += f" ({_size(line.size)})"
    if line.changed and not line.need.needed and "another picture" not in note and "rays a pixel" not in note:
        note += f" ({spaced(line.changed)} px differ)"
    added = signed(line.rays[1] - line.rays[0]) if line.rays else ""
    took = ratio = ""
    if line.turns:
        took = f"{1e3 * line.turns.extra:+.1f}".replace("-", "−") if line.turns.tells else "0"
        took += f" ±{1e3 * line.turns.doubt:.1f}" if line.turns.doubt else "     "
        ratio = f"×{line.turns.ratio:.2f}" if line.turns.without and line.turns.tells else ""
    return hanging(f"{line.need.name:{width}}{added:>14}{took:>15}{ratio:>8}   ", note).rstrip()


def hanging(head: str, text: str) -> str:
    """A row whose last column goes on below itself where it is too long."""
    return head + ("\n" + " " * len(head)).join(textwrap.wrap(text, max(20, WIDTH - len(head))))


def _verdict(image: Measured) -> list[str]:
    together = image.together
    assert together.rays and together.turns
    turns = together.turns
    same = "the same picture" if not together.changed else f"{spaced(together.changed)} pixels differ"
    before, after = 1e3 * turns.without, 1e3 * (turns.without + turns.extra)
    told = (
        f"At once all that the image leaves out and that would not change it ({together.how}; {same}): "
        f"{spaced(together.rays[1])} rays instead of {spaced(together.rays[0])}, {after:.1f} ms instead of "
        f"{before:.1f}, ×{turns.ratio:.2f}."
    )
    return textwrap.wrap(told, WIDTH)


def spaced(count: int) -> str:
    return f"{count:,}".replace(",", " ")


def signed(count: int) -> str:
    return ("+" if count > 0 else "−" if count < 0 else "") + spaced(abs(count))


def _size(size: tuple[int, int] | None) -> str:
    return f"{size[0]}x{size[1]}" if size else ""


def as_json(plan: Plan) -> str:
    document: dict[str, Any] = {"format": FORMAT, "scene": plan.scene}
    if plan.image:
        image = plan.image
        document["image"] = {"size": list(image.size), "depth": image.depth, "threads": 1, "rays": image.rays}
        document["together"] = entry("image", image.together)
    document["needs"] = [entry(part, line) for part, lines in plan.lines.items() for line in lines]
    return json.dumps(document, indent=1, allow_nan=False, ensure_ascii=False) + "\n"


def entry(part: str, line: Saving) -> dict[str, Any]:
    """A line; the measured values are those without the capability and with it."""
    found: dict[str, Any] = {"of": part, "name": line.need.name, "needed": line.need.needed, "why": line.need.why}
    if line.how:
        found["compared"] = line.how
    if line.rays:
        found["rays"] = {"without": line.rays[0], "with": line.rays[1]}
    if line.turns:
        turns = line.turns
        found["seconds"] = {"without": turns.without, "extra": turns.extra, "doubt": turns.doubt, "pairs": turns.pairs}
        found["estimated"] = line.estimated
    if line.size:
        found["size"], found["changed"] = list(line.size), line.changed
    return found
