"""The explanation of one ray: the lecture's formulas with its numbers.

Nothing here draws. Each number comes from the node table, or is computed from it by the formulas of
`tracer.formulas.optics`.
"""

import math

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from tracer.tree.text import END_REASONS, cut_summary
from viewer.base.wording import (
    format_angle,
    format_color,
    format_number,
    format_pair,
    format_point,
    format_rgb,
    format_weight,
)
from viewer.explain.fate import ray_fate
from viewer.explain.formulas import Lecture
from viewer.explain.intersection import intersection_sections
from viewer.explain.lighting import local_light, one_light
from viewer.explain.scattering import (
    brought_error,
    direction_error,
    local_error,
    origin_sections,
    scattering_sections,
)
from viewer.explain.sections import Part, RayDetails, Section

KIND_NAMES = {
    "camera": "Camera ray",
    "reflection": "Reflected ray",
    "refraction": "Refracted ray",
    "tir": "Total internal reflection",
    "shadow": "Shadow ray",
}


def headline(tree: RayTree, i: int) -> tuple[str, str]:
    """(name of the ray, its result), in a few words."""
    row = tree.nodes[i]
    name = f"{KIND_NAMES[tree.kind(i)]} {tree.label(i)}"
    if row["kind"] == SHADOW:
        from_object = tree.object_name(int(row["parent"]))
        return name, f"from {from_object} to {tree.light_name(i)}: {ray_fate(tree, i)}"
    fate = ray_fate(tree, i)
    if tree.object_name(i) and tree.digits(i) == 0:
        fate = f"{fate}, but rounding has left no correct digit of the point"
    why = END_REASONS[tree.end(i)]
    return name, f"{fate}; {why}" if why else fate


def ray_facts(tree: RayTree, i: int) -> str:
    """The kind of a ray, its weight and the medium that it runs in, in a line beside its label."""
    row = tree.nodes[i]
    if row["kind"] == SHADOW:
        return f"shadow ray from {tree.object_name(int(row['parent']))} to {tree.light_name(i)}"
    facts = [KIND_NAMES[tree.kind(i)].lower(), f"weight {format_number(float(row['weight'].max()), 3)}"]
    if tree.object_name(i) and tree.from_inside(i):
        facts.append(f"inside {tree.object_name(i)}")
    return ", ".join(facts)


def certainty(tree: RayTree, i: int) -> list[str]:
    """Paragraphs on what becomes of ray i, on what is missing, and on how certain its numbers are."""
    fate, missing = headline(tree, i)[1], cut_summary(tree)
    found = " ".join(map(_sentence, (fate, missing)))
    certain = ""
    if tree.object_name(i) and tree.nodes["kind"][i] != SHADOW:
        digits = tree.digits(i)
        certain = "1 digit of its point is certain. " if digits == 1 else f"{digits} digits of its point are certain. "
    return [found, f"{certain}Closest decision: {margin_text(tree, i)}."]


def ray_numbers(tree: RayTree, i: int) -> Section:
    """The numbers of row i."""
    row = tree.nodes[i]
    section = Section("Numbers")
    shadow = row["kind"] == SHADOW
    parent = int(row["parent"])
    section.add("kind", KIND_NAMES[tree.kind(i)].lower() + (f", sent by {tree.label(parent)}" if parent >= 0 else ""))
    section.add("depth", str(int(row["depth"])))
    section.add("object", tree.object_name(i) or "none")
    error, turn = float(row["error"]), direction_error(tree, i)
    section.add("distance t", format_number(row["t"], error=error))
    section.add("point", format_point(row["point"], error))
    if not math.isnan(error):
        section.add("estimated rounding error", f"{error:.1g}".replace("-", "−"))
    if not shadow:
        section.add("normal n", format_point(row["normal"], turn))
        section.add(Lecture.INDICES, format_pair(format_number(row["n1"]), format_number(row["n2"])))
        section.add(Lecture.ANGLES, format_pair(format_angle(row["theta1"], turn), format_angle(row["theta2"], turn)))
        if not math.isnan(row["radicand"]):
            section.add(Lecture.RADICAND, format_number(row["radicand"]))
    section.add("factor", format_weight(row["factor"], row["factor_error"]))
    section.add("weight", format_weight(row["weight"], row["weight_error"]))
    section.add("radiance", format_color(row["radiance"], row["radiance_error"]))
    section.add("ends", END_REASONS[tree.end(i)] or "no: it has children")
    section.add("path", tree.path(i))
    section.add("light path (Heckbert)", tree.light_path(i))
    return section


def margin_text(tree: RayTree, i: int) -> str:
    """The decision margin of ray i, with the decision, in words."""
    margins = tree.margins_of(np.array([i]))
    margin, words = float(margins.margin[0]), tree.decision(margins, 0)
    if not words:
        return "more than 10⁶ times the rounding error away"
    if margin < 1.0:
        return f"{words}: within the rounding error, so the ray could have gone otherwise"
    return f"{words}: {format_number(margin, 2)} times the rounding error away"


def explain_ray(tree: RayTree, world: World, i: int) -> list[Part]:
    """All about row i: how the ray came to be, what it meets and sends out, its numbers."""
    row = tree.nodes[i]
    label, parent, met = tree.label(i), int(row["parent"]), tree.object_name(i)
    numbers = Part("All of it", [ray_numbers(tree, i)])
    if row["kind"] == SHADOW:
        title = f"{tree.label(parent)} meets {tree.object_name(parent)}: its light"
        return [Part(title, [one_light(tree, world, parent, int(row["light"]))]), numbers]
    begun = []
    if parent >= 0:
        begun = [
            Part(
                f"{label} starts where {tree.label(parent)} meets {tree.object_name(parent)}", origin_sections(tree, i)
            )
        ]
    if not met:
        return [*begun, Part(f"{label} meets nothing", [_sum(tree, i)]), numbers]
    sections = [_sum(tree, i), *intersection_sections(tree, i), *scattering_sections(tree, i)]
    return [*begun, Part(f"{label} meets {met}", [*sections, local_light(tree, world, i)]), numbers]


def ray_details(tree: RayTree, world: World, i: int) -> RayDetails:
    """All about row i, for a figure that carries it along."""
    name, fate = headline(tree, i)
    *ends, numbers = explain_ray(tree, world, i)
    return RayDetails(i, name, (_sentence(fate), certainty(tree, i)[1]), (numbers, *ends))


def _sentence(words: str) -> str:
    return f"{words[0].upper()}{words[1:]}."


def _sum(tree: RayTree, i: int) -> Section:
    """The ray's radiance, written as a sum."""
    row = tree.nodes[i]
    section = Section("Radiance", Lecture.RADIANCE)
    if tree.end(i) == "background":
        section.add("background", format_rgb(row["radiance"], 4))
        return section
    section.add("local", format_color(row["local"], local_error(tree, i)))
    for child in tree.children[i]:
        below = tree.nodes[child]
        if below["kind"] != SHADOW:
            factor = format_weight(below["factor"], below["factor_error"])
            section.add(
                f"+ {factor} × {tree.label(child)}",
                format_color(below["factor"] * below["radiance"], brought_error(below)),
            )
    section.add("=", format_color(row["radiance"], row["radiance_error"]))
    return section
