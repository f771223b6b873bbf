"""The rays that a hit sends out: the lecture's formulas with their numbers.

Each number comes from the node table, or is computed from it by the formulas of `tracer.formulas.optics`.
"""

import math

import numpy as np

from tracer.choices import MODELS
from tracer.formulas import optics
from tracer.formulas.double_double import U
from tracer.formulas.vector import vector
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_angle, format_number, format_point
from viewer.explain.formulas import Lecture
from viewer.explain.sections import Section


def direction_error(tree: RayTree, i: int) -> float:
    """The largest estimated rounding error of the directions at hit i: of the ray itself and of those it sends out."""
    return float(max(tree.nodes["turn"][k] for k in (i, *tree.children[i])))


def brought_error(row: np.void) -> float:
    """Bound on the rounding error of what a ray brings its parent: its factor times its radiance."""
    return float(row["factor"].max() * row["radiance_error"] + row["factor_error"] * row["radiance"].max())


def local_error(tree: RayTree, i: int) -> float:
    """Bound on the rounding error of the local term at hit i: of its radiance, less that of the rays that it sends
    out.
    """
    below = [tree.nodes[k] for k in tree.children[i] if tree.nodes["kind"][k] != SHADOW]
    return max(float(tree.nodes["radiance_error"][i]) - sum(map(brought_error, below)), 0.0)


def scattering_sections(tree: RayTree, i: int) -> list[Section]:
    """The directions and factors of the rays that hit i sends out."""
    row = tree.nodes[i]
    material = tree.scene.objects[row["object"]].material
    sections = []
    tir = row["radicand"] <= 0.0
    if not math.isnan(row["radicand"]):
        sections += _refraction(tree, i)
        if tree.model == MODELS[1] and not tir:
            sections.append(_fresnel(tree, i))
    if material.reflect > 0.0 or tir or (tree.model == MODELS[1] and material.transmit > 0.0):
        sections.append(_reflection(tree, i))
    return sections


def origin_sections(tree: RayTree, i: int) -> list[Section]:
    """The formulas by which ray i, which is neither the camera ray nor a shadow ray, got its direction and factor at
    the hit that sends it out.
    """
    hit, kind = int(tree.nodes["parent"][i]), tree.kind(i)
    sections = [] if kind == "reflection" else _refraction(tree, hit)
    if kind != "refraction":
        sections.append(_reflection(tree, hit))
    if kind != "tir" and tree.model == MODELS[1] and not math.isnan(tree.nodes["radicand"][hit]):
        sections.append(_fresnel(tree, hit))
    return sections


def _refraction(tree: RayTree, i: int) -> list[Section]:
    row = tree.nodes[i]
    critical = [_critical(tree, i)] if row["n1"] > row["n2"] else []
    return [_snell(tree, i), *critical, _transmission(tree, i)]


def _child(tree: RayTree, i: int, *kinds: str) -> str:
    """The label of the ray of one of these kinds that hit i sends out; empty if there is none."""
    return next((tree.label(k) for k in tree.children[i] if tree.kind(k) in kinds), "")


def _snell(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    n1, n2 = float(row["n1"]), float(row["n2"])
    left = n1 * math.sin(row["theta1"])
    turn = direction_error(tree, i)
    section = Section("Snell's law", Lecture.SNELL)
    section.add(f"{format_number(n1)} · sin {format_angle(row['theta1'], turn)}", format_number(left, error=n1 * turn))
    if row["radicand"] > 0.0:
        section.add(
            f"{format_number(n2)} · sin {format_angle(row['theta2'], turn)}",
            format_number(n2 * math.sin(row["theta2"]), error=n2 * turn),
        )
    else:
        section.add(Lecture.TOO_LARGE_SINE, f"would be {format_number(left / n2)} > 1")
    return section


def _critical(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    n1, n2 = float(row["n1"]), float(row["n2"])
    critical = optics.critical_angle(n1, n2)
    assert critical is not None
    section = Section("Critical angle", Lecture.CRITICAL)
    section.add(f"arcsin({format_number(n2)} / {format_number(n1)})", format_angle(critical))
    beyond = row["radicand"] <= 0.0
    section.add(
        f"θ₁ = {format_angle(row['theta1'], direction_error(tree, i))}",
        "beyond it: total internal reflection" if beyond else "below it",
    )
    return section


def _transmission(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    v, normal = vector(row["direction"]), vector(row["normal"])
    n1, n2 = float(row["n1"]), float(row["n2"])
    c1 = optics.cosine(v, normal)
    root = float(row["radicand"])
    turn = direction_error(tree, i)
    section = Section("Transmission direction", Lecture.TRANSMISSION)
    section.add(Lecture.ETA, format_number(n1 / n2))
    section.add(Lecture.COSINE_1, format_number(c1, error=turn))
    section.add(Lecture.RADICAND, format_number(root, error=2.0 * (n1 / n2) ** 2 * turn))
    if root <= 0.0:
        section.add(Lecture.TOO_LARGE, f"{format_number(1.0 - root)} ≥ 1: total internal reflection")
        return section
    c2 = math.sqrt(root)
    section.add(Lecture.COSINE_2, format_number(c2, error=turn))
    section.add(Lecture.INCOMING, format_point(v, turn), tree.label(i))
    section.add(Lecture.NORMAL, format_point(normal, turn))
    if n1 == n2:
        section.add(Lecture.STRAIGHT, "equal indices: straight on", _child(tree, i, "refraction"))
    else:
        with np.errstate(invalid="ignore"):
            t = optics.transmission(v, normal, n1, n2, c1, c2)
        words = format_point(t, turn) if math.isfinite(sum(t)) else "rounding leaves no direction"
        section.add(Lecture.REFRACTED, words, _child(tree, i, "refraction"))
    return section


def _fresnel(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    item = tree.scene.objects[row["object"]]
    material = item.material
    v, normal = vector(row["direction"]), vector(row["normal"])
    n1, n2 = float(row["n1"]), float(material.ior if item.thin else row["n2"])
    c1 = min(1.0, optics.cosine(v, normal))
    c2 = math.sqrt(max(optics.radicand(optics.sine(v, normal), n1, n2), 0.0))
    r, t = optics.fresnel(c1, n1, n2)
    section = Section("Fresnel", Lecture.FRESNEL)
    section.add(Lecture.AMPLITUDE_S, format_number(_amplitude(n1 * c1, n2 * c2)))
    section.add(Lecture.AMPLITUDE_P, format_number(_amplitude(n2 * c1, n1 * c2)))
    share = material.reflect + material.transmit
    rays = (_child(tree, i, "reflection"), _child(tree, i, "refraction"))
    section.add(Lecture.REFLECTANCE, format_number(r), rays[0] if share == 1.0 else "")
    section.add(Lecture.TRANSMITTED, format_number(t), rays[1] if share == 1.0 else "")
    if share != 1.0:
        section.add(Lecture.SHARE_R, format_number(share * r), rays[0])
        section.add(Lecture.SHARE_T, format_number(share * t), rays[1])
    return section


def _amplitude(a: float, b: float) -> float:
    """(a - b) / (a + b); 0 if the difference is only rounding error, as at Brewster's angle."""
    return (a - b) / (a + b) if abs(a - b) > 4.0 * U * (a + b) else 0.0


def _reflection(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    v, n = vector(row["direction"]), vector(row["normal"])
    turn = direction_error(tree, i)
    section = Section("Reflection", Lecture.REFLECTION)
    section.add(Lecture.INCOMING, format_point(v, turn), tree.label(i))
    section.add(Lecture.NORMAL, format_point(n, turn))
    section.add(Lecture.COSINE, format_number(-optics.cosine(v, n), error=turn))
    section.add(Lecture.REFLECTED, format_point(optics.reflect(v, n), turn), _child(tree, i, "reflection", "tir"))
    return section
