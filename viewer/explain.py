"""What the picked ray does and why, in the lecture's formulas with its own numbers put in.

Sections of lines, for panels to lay out and tests to read: nothing here draws. Every number is taken from the node
table or worked out again from it by the formulas of `tracer.optics`.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from tracer import optics
from tracer.limits import MODELS
from tracer.nodes import SHADOW
from tracer.outline import WHY
from tracer.pairs import U
from tracer.scene import Material
from tracer.shading import surface_color
from tracer.tree import RayTree
from tracer.vector import vector
from tracer.world import World
from viewer.theme import STYLES
from viewer.wording import angle, pair, place, same, shown, triple


@dataclass(frozen=True)
class Line:
    """A name with its value, or a formula with its numbers below it."""

    name: str
    value: str = ""


@dataclass
class Section:
    title: str
    formula: str = ""  # as on the slide
    lines: list[Line] = field(default_factory=list)

    def add(self, name: str, value: str = "") -> None:
        self.lines.append(Line(name, value))


KIND_NAMES = {
    "camera": "Camera ray",
    "reflection": "Reflected ray",
    "refraction": "Refracted ray",
    "tir": "Total internal reflection",
    "shadow": "Shadow ray",
}


def headline(tree: RayTree, i: int) -> tuple[str, str]:
    """(which ray, what becomes of it) in a few words."""
    row = tree.nodes[i]
    name = KIND_NAMES[tree.kind(i)]
    if row["kind"] == SHADOW:
        from_object = tree.object_name(int(row["parent"]))
        return f"{name} {i}", f"from {from_object} to {tree.light_name(i)}: {_shadow_fate(tree, i)}"
    met = tree.object_name(i)
    fate = f"meets {met}" if met else "meets nothing"
    if met and tree.digits(i) == 0:
        fate = f"{fate}, or so it seems: rounding has left no digit of where"
    why = WHY[tree.end(i)]
    return f"{name} {i}", f"{fate}; {why}" if why else fate


def _shadow_fate(tree: RayTree, i: int) -> str:
    met = tree.object_name(i)
    if tree.faces_away(i):
        return "adds nothing, the surface faces away from the light"
    return {"blocked": f"blocked by {met}", "filtered": f"dimmed by {met}, straight through"}.get(
        tree.end(i) or "", "nothing in its way"
    )


def numbers(tree: RayTree, i: int) -> Section:
    """The row itself."""
    row = tree.nodes[i]
    section = Section("Numbers")
    shadow = row["kind"] == SHADOW
    parent = int(row["parent"])
    section.add("kind", KIND_NAMES[tree.kind(i)].lower() + (f", sent by ray {parent}" if parent >= 0 else ""))
    section.add("depth", str(int(row["depth"])))
    section.add("object", tree.object_name(i) or "none")
    error, turn = float(row["error"]), turned(tree, i)
    section.add("distance t", shown(row["t"], error=error))
    section.add("point", place(row["point"], error))
    if not math.isnan(error):
        section.add("rounding may move it by", f"{error:.1g}".replace("-", "−"))
    if not shadow:
        section.add("normal n", place(row["normal"], turn))
        section.add("n₁ → n₂", pair(shown(row["n1"]), shown(row["n2"])))
        section.add("θ₁ → θ₂", pair(angle(row["theta1"], turn), angle(row["theta2"], turn)))
        if not math.isnan(row["radicand"]):
            section.add("1 − η²(1 − c₁²)", shown(row["radicand"]))
    section.add("factor", same(row["factor"]))
    section.add("weight", same(row["weight"]))
    section.add("sends up", triple(row["radiance"], 4))
    section.add("ends", WHY[tree.end(i)] or "its children go on")
    section.add("path", tree.path(i))
    return section


def turned(tree: RayTree, i: int) -> float:
    """How far rounding may have turned the directions at hit i: the ray's own and those it sends on."""
    return float(max(tree.nodes["turn"][k] for k in (i, *tree.children[i])))


def explain(tree: RayTree, world: World, i: int) -> list[Section]:
    """All there is to say about row i, the most telling first."""
    row = tree.nodes[i]
    if row["kind"] == SHADOW:
        parent = int(row["parent"])
        return [_light(tree, world, parent, int(row["light"])), numbers(tree, i)]
    if math.isnan(row["t"]):
        return [_sum(tree, i), numbers(tree, i)]
    return [_sum(tree, i), *directions(tree, i), _local(tree, world, i), numbers(tree, i)]


def directions(tree: RayTree, i: int) -> list[Section]:
    """Where the rays go that hit i sends out, and what they are worth."""
    row = tree.nodes[i]
    material = tree.scene.objects[row["object"]].material
    sections = []
    tir = row["radicand"] <= 0.0
    if not math.isnan(row["radicand"]):
        sections.append(_snell(tree, i))
        if row["n1"] > row["n2"]:
            sections.append(_critical(tree, i))
        sections.append(_transmission(tree, i))
        if tree.model == MODELS[1] and not tir:
            sections.append(_fresnel(tree, i, material))
    if material.reflect > 0.0 or tir or (tree.model == MODELS[1] and material.transmit > 0.0):
        sections.append(_reflection(tree, i))
    return sections


def _sum(tree: RayTree, i: int) -> Section:
    """What the ray sends up, as the sum it is."""
    row = tree.nodes[i]
    section = Section("What it sends up", "I = local + Σ factor × child")
    if tree.end(i) == "background":
        section.add("background", triple(row["radiance"], 4))
        return section
    section.add("local", triple(row["local"], 4))
    for child in tree.children[i]:
        below = tree.nodes[child]
        if below["kind"] != SHADOW:
            section.add(
                f"+ {same(below['factor'])} × ray {child} ({STYLES[tree.kind(child)].letter})",
                triple(below["factor"] * below["radiance"], 4),
            )
    section.add("=", triple(row["radiance"], 4))
    return section


def _snell(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    n1, n2 = float(row["n1"]), float(row["n2"])
    left = n1 * math.sin(row["theta1"])
    turn = turned(tree, i)
    section = Section("Snell's law", "n₁ sin θ₁ = n₂ sin θ₂")
    section.add(f"{shown(n1)} · sin {angle(row['theta1'], turn)}", shown(left, error=n1 * turn))
    if row["radicand"] > 0.0:
        section.add(
            f"{shown(n2)} · sin {angle(row['theta2'], turn)}", shown(n2 * math.sin(row["theta2"]), error=n2 * turn)
        )
    else:
        section.add("sin θ₂ would be", f"{shown(left / n2)} > 1")
    return section


def _critical(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    n1, n2 = float(row["n1"]), float(row["n2"])
    critical = optics.critical_angle(n1, n2)
    assert critical is not None
    section = Section("Critical angle", "θc = asin(n₂ / n₁)")
    section.add(f"asin({shown(n2)} / {shown(n1)})", angle(critical))
    beyond = row["radicand"] <= 0.0
    section.add(
        f"θ₁ = {angle(row['theta1'], turned(tree, i))}",
        "beyond it: total internal reflection" if beyond else "below it",
    )
    return section


def _transmission(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    v, normal = vector(row["direction"]), vector(row["normal"])
    n1, n2 = float(row["n1"]), float(row["n2"])
    c1 = optics.cosine(v, normal)
    root = float(row["radicand"])
    turn = turned(tree, i)
    section = Section("Transmission direction", "t = η v + (η c₁ − c₂) n,  η = n₁/n₂")
    section.add("η = n₁/n₂", shown(n1 / n2))
    section.add("c₁ = −v·n", shown(c1, error=turn))
    section.add("1 − η²(1 − c₁²)", shown(root, error=2.0 * (n1 / n2) ** 2 * turn))
    if root <= 0.0:
        section.add("η²(1 − c₁²)", f"{shown(1.0 - root)} ≥ 1: total internal reflection")
        return section
    c2 = math.sqrt(root)
    section.add("c₂ = √", shown(c2, error=turn))
    section.add("v", place(v, turn))
    section.add("n", place(normal, turn))
    if n1 == n2:
        section.add("t = v", "equal indices: straight on")
    else:
        section.add("t", place(optics.transmission(v, normal, n1, n2, c1, c2), turn))
    return section


def _fresnel(tree: RayTree, i: int, material: Material) -> Section:
    row = tree.nodes[i]
    v, normal = vector(row["direction"]), vector(row["normal"])
    thin = row["n1"] == row["n2"]
    n1, n2 = float(row["n1"]), float(material.ior if thin else row["n2"])
    c1 = min(1.0, optics.cosine(v, normal))
    c2 = math.sqrt(max(optics.radicand(optics.sine(v, normal), n1, n2), 0.0))
    r, t = optics.fresnel(c1, n1, n2)
    section = Section("Fresnel", "reflected kr + kt R,  refracted kt T")
    section.add("rₛ = (n₁c₁ − n₂c₂) / (n₁c₁ + n₂c₂)", shown(_share(n1 * c1, n2 * c2)))
    section.add("rₚ = (n₂c₁ − n₁c₂) / (n₂c₁ + n₁c₂)", shown(_share(n2 * c1, n1 * c2)))
    section.add("R = (rₛ² + rₚ²) / 2", shown(r))
    section.add("T, computed for itself", shown(t))
    section.add("kr + kt R", shown(material.reflect + material.transmit * r))
    section.add("kt T", shown(material.transmit * t))
    return section


def _share(a: float, b: float) -> float:
    """(a - b) / (a + b), and 0 where the difference is no more than the rounding of a and b, as at Brewster's angle."""
    return (a - b) / (a + b) if abs(a - b) > 4.0 * U * (a + b) else 0.0


def _reflection(tree: RayTree, i: int) -> Section:
    row = tree.nodes[i]
    v, n = vector(row["direction"]), vector(row["normal"])
    turn = turned(tree, i)
    section = Section("Reflection", "r = v − 2 (n·v) n")
    section.add("v", place(v, turn))
    section.add("n", place(n, turn))
    section.add("n·v", shown(-optics.cosine(v, n), error=turn))
    section.add("r", place(optics.reflect(v, n), turn))
    return section


def _local(tree: RayTree, world: World, i: int) -> Section:
    """The local term, light by light."""
    row = tree.nodes[i]
    material = world.scene.objects[row["object"]].material
    section = Section("Local light", "I = A ka C + Σ S L (kd C (N·L) + ks (R·V)ᵖ)")
    color = _color(world, tree, i)
    ambient = np.array(world.scene.tracing.ambient) * material.ambient * color
    section.add("colour C", triple(color, 3))
    section.add(f"ambient: A · {shown(material.ambient)} · C", triple(ambient, 4))
    rows = {int(tree.nodes["light"][child]): child for child in tree.children[i]}
    for j, light in enumerate(world.scene.lights):
        name = light.name or f"light {j}"
        child = rows[j]
        n_l, r_v = _cosines(tree, i, child)
        if n_l <= 0.0:
            detail = f"N·L {shown(n_l, 3)}: faces away from it"
        elif tree.end(child) == "blocked":
            detail = f"blocked by {tree.object_name(child)}"
        else:
            detail = f"N·L {shown(n_l, 3)}, R·V {shown(max(r_v, 0.0), 3)}"
            if tree.end(child) == "filtered":
                detail += f", × {shown(tree.nodes['factor'][child][0], 3)} through glass (S)"
        section.add(f"{name}: {detail}", triple(tree.nodes["radiance"][child], 4))
    section.add("local", triple(row["local"], 4))
    return section


def _light(tree: RayTree, world: World, i: int, j: int) -> Section:
    """One light's share at hit i."""
    row = tree.nodes[i]
    light = world.scene.lights[j]
    child = next(c for c in tree.children[i] if tree.nodes["light"][c] == j)
    material = world.scene.objects[row["object"]].material
    n_l, r_v = _cosines(tree, i, child)
    color = _color(world, tree, i)
    section = Section(f"Light from {light.name or f'light {j}'}", "S L (kd C (N·L) + ks (R·V)ᵖ)")
    section.add("light L", triple(light.color, 3))
    section.add("N·L", shown(n_l))
    if n_l <= 0.0:
        section.add("N·L ≤ 0", "the surface faces away from it: no light")
        return section
    section.add("kd C (N·L)", triple(material.diffuse * n_l * color, 4))
    highlight = material.specular * r_v**material.shininess if r_v > 0.0 else 0.0
    section.add("R·V", shown(r_v))
    section.add(f"ks (R·V)ᵖ, p = {shown(material.shininess)}", f"{highlight:.4f}")
    section.add("S: gets through", same(tree.nodes["factor"][child]))
    section.add("share", triple(tree.nodes["radiance"][child], 4))
    return section


def _cosines(tree: RayTree, i: int, child: int) -> tuple[float, float]:
    """N·L and R·V at hit i, for the light that its shadow ray goes to."""
    row = tree.nodes[i]
    n, to_light = np.array(row["normal"]), tree.nodes["direction"][child]
    n_l = float(n @ to_light)
    r = 2.0 * n_l * n - to_light
    return n_l, float(r @ -row["direction"])


def _color(world: World, tree: RayTree, i: int) -> np.ndarray:
    row = tree.nodes[i]
    this = world.arrays.objects[row["object"]]
    material = world.arrays.materials[this["material"]]
    return np.array(surface_color(material, this, vector(row["point"])))
