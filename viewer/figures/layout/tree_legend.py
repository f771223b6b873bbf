"""What the legend of a tree figure explains."""

from tracer.kernel.nodes import SHADOW
from viewer.base.theme import STYLES
from viewer.figures.labels import CUTS
from viewer.figures.layout.light_line import SIGNS
from viewer.figures.layout.sizes import shortened
from viewer.figures.layout.tree_plan import TreePlan
from viewer.figures.legend import CUT, Entry
from viewer.figures.lights import FATES, counted, fate_of, shadow_rays


def tree_entries(plan: TreePlan) -> list[Entry]:
    """The entries of the legend: lines and signs of the deepest step."""
    kinds = {plan.tree.kind(i) for i in plan.rows}
    rays = [Entry(kind, STYLES[kind].label) for kind in ("reflection", "refraction", "tir") if kind in kinds]
    return [*rays, *sign_entries(plan)]


def sign_entries(plan: TreePlan) -> list[Entry]:
    """The signs in and below the boxes, and the order of the lights."""
    tree, lines = plan.tree, plan.places.lines
    entries: list[Entry] = []
    shadows = [i for i in plan.rows if tree.nodes["kind"][i] == SHADOW]
    if plan.style.compact and any(tree.end(i) in CUTS for i in plan.rows):
        entries.append(Entry(CUT, "cut", stub=False))
    ends = {fate_of(tree, i).name for i in shadows}
    if plan.style.line == SIGNS and not plan.style.compact:
        ends |= {fate.name for hit in lines for fate, _ in counted(tree, shadow_rays(tree, hit))}
    if any(tree.adds_nothing(i) for i in plan.rows if tree.nodes["kind"][i] != SHADOW):
        ends.add("nothing")
    entries += [Entry(fate.name, fate.legend, not plan.style.compact) for fate in FATES if fate.name in ends]
    lights = [tree.scene.light_name(j) for j in range(len(tree.scene.lights))]
    if shadows:  # each hit has a stub for each light, in this order
        entries.append(Entry("lights", f"L: {', '.join(shortened(name) for name in lights)}"))
    elif lines:
        entries.append(Entry("lights", f"L: rays to {_number(len(lights))}"))
    elif plan.lights_left_out:
        entries.append(Entry("lights", f"L: rays to {_number(len(lights))} are left out"))
    return entries


def _number(lights: int) -> str:
    return "1 light" if lights == 1 else f"{lights} lights"
