"""`raytree plan`: which capabilities a scene needs, which are left out, and with `--measure` what each costs."""

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tracer.kernel.capabilities import Need
from tracer.measure.plan.savings import Measured, Saving, measure
from tracer.printable import json_text
from tracer.scene import Scene
from tracer.shapes.polygon import Polygon
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.loading import faults, find, prepared
from viewer.cli.options import PlanOptions
from viewer.cli.terminal import compile_once
from viewer.gl.features import shader_needs

FORMAT = "raytree-plan/1"
WIDTH = 100  # of running text


@dataclass(frozen=True)
class Plan:
    """The needs of a scene, and the savings if they were measured."""

    scene: str
    image: Sequence[Need]
    window: Sequence[Need]
    notes: Sequence[str] = ()
    measured: Measured | None = None


def plan(options: PlanOptions) -> int:
    path, lesson = find(options.scene)
    with faults():
        world = prepared(path, options.up, prints_notes=False)
    found = None
    if options.measure:
        compile_once()
        with Progress("measuring") as progress:
            found = measure(world, progress)
    made = Plan(world.scene.caption, world.needs, window_needs(world.scene, lesson is not None), world.notes, found)
    put(as_json(made) if options.json else as_text(made))
    return 0


def window_needs(scene: Scene, in_lesson: bool) -> list[Need]:
    """The capabilities of the window that the scene needs."""
    cut = any(isinstance(item.shape, Polygon) for item in scene.objects)
    return [
        *shader_needs(scene),
        Need("polygon triangulation", cut, "polygons in the 3D view" if cut else "no polygon in the 3D view"),
        Need("lesson panel", in_lesson, "a lesson" if in_lesson else "the scene belongs to no lesson"),
    ]


def as_text(plan: Plan) -> str:
    """A table of the needs with their reasons, and below it the measurements."""
    lines = [plan.scene]
    width = max(len(need.name) for need in (*plan.image, *plan.window))
    for title, needs in (("THE IMAGE", plan.image), ("THE WINDOW", plan.window)):
        lines += ["", title]
        for need in needs:
            state = "needed" if need.needed else "left out"
            lines.append(hanging(f"{need.name:{width}}  {state:8}  ", need.why))
    if plan.notes:
        lines += ["", "NOTES", *(hanging("", note) for note in plan.notes)]
    if plan.measured:
        lines += ["", *_measured(plan.measured, width), "", *_together(plan.measured)]
    return "\n".join(lines) + "\n"


def _measured(image: Measured, width: int) -> Iterator[str]:
    """The table of what each capability costs."""
    rays = ", ".join(f"{spaced(count)} {kind}" for kind, count in image.rays.items() if count)
    yield f"MEASURED with and without, in turn, n times. The image: {_size(image.size)}, depth {image.depth}, one"
    yield from textwrap.wrap(f"thread, {rays} rays", WIDTH)
    for needed, title in ((False, "left out: added cost"), (True, "needed: cost")):
        savings = [saving for saving in image.savings if saving.need.needed == needed]
        if savings:
            yield ""
            yield f"{title:{width + 9}}{'rays':>5}{'ms':>15}{'times':>8}{'n':>5}   {'without' if needed else 'with'}"
            yield from (_row(saving, image, width) for saving in savings)
        if any(s.times and s.times.is_significant and s.times.extra < 0.0 for s in savings):
            yield f"{'':{width}}  (negative: it saves time)"


def _row(saving: Saving, image: Measured, width: int) -> str:
    note = saving.how
    if saving.size not in (None, image.size):
        note += f" ({_size(saving.size)})"
    if saving.changed and not saving.need.needed and "another picture" not in note:
        note += f" ({spaced(saving.changed)} px differ)"
    added = signed(saving.rays[1] - saving.rays[0]) if saving.rays else ""
    took = ratio = pairs = ""
    if times := saving.times:
        took = f"{1e3 * times.extra:+.1f}".replace("-", "−") if times.is_significant else "0"
        took += f" ±{1e3 * times.uncertainty:.1f}"
        ratio = f"×{times.ratio:.2f}" if times.is_significant else ""
        pairs = str(times.pairs)
    return hanging(f"{saving.need.name:{width}}{added:>14}{took:>15}{ratio:>8}{pairs:>5}   ", note).rstrip()


def hanging(head: str, text: str) -> str:
    """A row whose last column is wrapped below itself."""
    return head + ("\n" + " " * len(head)).join(textwrap.wrap(text, max(20, WIDTH - len(head))))


def _together(image: Measured) -> list[str]:
    """The saving of all that is left out, as a sentence."""
    together = image.together
    assert together.rays and together.times
    times = together.times
    same = "the same picture" if not together.changed else f"{spaced(together.changed)} pixels differ"
    before, after = 1e3 * times.without, 1e3 * (times.without + times.extra)
    told = (
        f"With all left-out capabilities that do not change the image ({together.how}; {same}): "
        f"{spaced(together.rays[1])} rays instead of {spaced(together.rays[0])}, {after:.1f} ms instead of "
        f"{before:.1f}, ×{times.ratio:.2f} (medians of {times.pairs} pairs)."
    )
    return textwrap.wrap(told, WIDTH)


def spaced(count: int) -> str:
    """A number in groups of three digits."""
    return f"{count:,}".replace(",", " ")


def signed(count: int) -> str:
    return ("+" if count > 0 else "−" if count < 0 else "") + spaced(abs(count))


def _size(size: tuple[int, int] | None) -> str:
    return f"{size[0]}x{size[1]}" if size else ""


def as_json(plan: Plan) -> str:
    """The plan for programs."""
    document: dict[str, Any] = {"format": FORMAT, "scene": plan.scene, "notes": list(plan.notes)}
    savings = {}
    if image := plan.measured:
        document["image"] = {"size": list(image.size), "depth": image.depth, "threads": 1, "rays": image.rays}
        document["together"] = {"of": "image", **_need(image.together.need), **_saving(image.together)}
        savings = {saving.need.name: _saving(saving) for saving in image.savings}
    document["needs"] = [{"of": "image", **_need(need), **savings.get(need.name, {})} for need in plan.image]
    document["needs"] += [{"of": "frame", **_need(need)} for need in plan.window]
    return json_text(document, indent=1) + "\n"


def _need(need: Need) -> dict[str, Any]:
    return {"name": need.name, "needed": need.needed, "why": need.why}


def _saving(saving: Saving) -> dict[str, Any]:
    """The measured values are those without the capability and with it."""
    found: dict[str, Any] = {"compared": saving.how}
    if saving.rays:
        found["rays"] = {"without": saving.rays[0], "with": saving.rays[1]}
    if times := saving.times:
        found["seconds"] = {
            "without": times.without, "extra": times.extra, "doubt": times.uncertainty, "pairs": times.pairs
        }  # fmt: skip
        found["estimated"] = saving.estimated
    if saving.size:
        found["size"], found["changed"] = list(saving.size), saving.changed
    return found
