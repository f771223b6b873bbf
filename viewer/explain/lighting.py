"""The local term at a hit (ambient light and the contributions of the lights), with its numbers."""

import sys

import numpy as np

from tracer.formulas.shading import surface_color
from tracer.formulas.vector import vector
from tracer.kernel.world import World
from tracer.scene import Material
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_color, format_number, format_rgb, format_weight
from viewer.explain.formulas import Lecture
from viewer.explain.scattering import local_error
from viewer.explain.sections import Section


def local_light(tree: RayTree, world: World, i: int, most: int = sys.maxsize) -> Section:
    """The local term of hit i, light by light; if there are more than `most` lights, with one line for all of them."""
    row = tree.nodes[i]
    material = world.scene.objects[row["object"]].material
    section = Section("Local light", Lecture.LOCAL)
    color = hit_color(world, tree, i)
    ambient = _ambient(world, material, color)
    section.add(Lecture.COLOR, format_rgb(color, 3))
    section.add(Lecture.COEFFICIENTS, "  ".join(format_number(x, 3) for x in _numbers(material)))
    section.add(f"ambient: A · {format_number(material.ambient)} · C", format_rgb(ambient, 4))
    lights = world.scene.lights
    if len(lights) <= most:
        _add_lights(section, tree, world, i)
    else:
        of_lights = np.sum([tree.nodes["local"][c] for c in tree.children[i] if tree.nodes["light"][c] >= 0], axis=0)
        section.add(f"Σ over {len(lights)} lights", format_color(of_lights, local_error(tree, i)))
    section.add("local", format_color(row["local"], local_error(tree, i)))
    return section


def _add_lights(section: Section, tree: RayTree, world: World, i: int) -> None:
    """Add the share of each light at hit i."""
    rows = {int(tree.nodes["light"][child]): child for child in tree.children[i]}
    for j, light in enumerate(world.scene.lights):
        name = world.scene.light_name(j)
        child = rows[j]
        n_l, r_v = light_cosines(tree, i, child)
        if n_l <= 0.0:
            detail = f"N·L {format_number(n_l, 3)}: surface faces away"
        elif tree.end(child) == "blocked":
            detail = f"blocked by {tree.object_name(child)}"
        else:
            section.add(f"{name}: L", format_rgb(light.color, 3))
            detail = f"N·L {format_number(n_l, 3)}, R·V {format_number(max(r_v, 0.0), 3)}"
            if tree.end(child) == "filtered":
                detail += f", × {format_number(tree.nodes['factor'][child][0], 3)} through glass (S)"
        section.add(
            f"{name}: {detail}", format_color(tree.nodes["radiance"][child], tree.nodes["radiance_error"][child])
        )


def one_light(tree: RayTree, world: World, i: int, j: int) -> Section:
    """The contribution of light j at hit i."""
    row = tree.nodes[i]
    light = world.scene.lights[j]
    child = next(c for c in tree.children[i] if tree.nodes["light"][c] == j)
    material = world.scene.objects[row["object"]].material
    n_l, r_v = light_cosines(tree, i, child)
    color = hit_color(world, tree, i)
    section = Section(f"Light from {world.scene.light_name(j)}", Lecture.ONE_LIGHT)
    section.add(Lecture.LIGHT, format_rgb(light.color, 3))
    section.add(Lecture.TO_LIGHT, format_number(n_l))
    if n_l <= 0.0:
        section.add(Lecture.FACES_AWAY, "the surface faces away from it: no light")
        return section
    section.add(Lecture.DIFFUSE, format_rgb(material.diffuse * n_l * color, 4))
    section.add(Lecture.MIRRORED, format_number(r_v))
    section.add(Lecture.EXPONENT, format_number(material.shininess))
    section.add(Lecture.HIGHLIGHT, f"{_highlight(material, r_v):.4f}")
    section.add(
        "S: fraction that arrives", format_weight(tree.nodes["factor"][child], tree.nodes["factor_error"][child])
    )
    section.add("contribution", format_color(tree.nodes["radiance"][child], tree.nodes["radiance_error"][child]))
    return section


def _numbers(material: Material) -> tuple[float, float, float, float]:
    return (material.ambient, material.diffuse, material.specular, material.shininess)


def phong_terms(tree: RayTree, world: World, i: int, child: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ambient term at hit i, and the diffuse and the specular term of the light of the shadow ray `child`, each a
    linear colour (3,). The last two add up to that ray's radiance, to rounding.
    """
    material = world.scene.objects[tree.nodes["object"][i]].material
    color = hit_color(world, tree, i)
    n_l, r_v = light_cosines(tree, i, child)
    arriving = np.array(world.scene.lights[tree.nodes["light"][child]].color) * tree.nodes["factor"][child]
    arriving = arriving * (n_l > 0.0 and tree.end(child) != "blocked")
    diffuse = arriving * material.diffuse * max(n_l, 0.0) * color
    return _ambient(world, material, color), diffuse, arriving * _highlight(material, r_v)


def _ambient(world: World, material: Material, color: np.ndarray) -> np.ndarray:
    return np.array(world.scene.tracing.ambient) * material.ambient * color


def _highlight(material: Material, r_v: float) -> float:
    """ks (R·V)^p, 0 on the side of the mirrored light that faces away."""
    return material.specular * r_v**material.shininess if r_v > 0.0 else 0.0


def light_cosines(tree: RayTree, i: int, child: int) -> tuple[float, float]:
    """N·L and R·V at hit i, for the light of a shadow ray."""
    row = tree.nodes[i]
    n, to_light = np.array(row["normal"]), tree.nodes["direction"][child]
    n_l = float(n @ to_light)
    r = 2.0 * n_l * n - to_light
    return n_l, float(r @ -row["direction"])


def hit_color(world: World, tree: RayTree, i: int) -> np.ndarray:
    """The colour C of the surface at hit i, linear (3,): of its material, or of its checkers."""
    row = tree.nodes[i]
    this = world.arrays.objects[row["object"]]
    material = world.arrays.materials[this["material"]]
    return np.array(surface_color(material, this, vector(row["point"])))
