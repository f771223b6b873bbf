"""Translate a scene for an independent program, POV-Ray (Debian package povray), and render it there.

POV-Ray's finish has the terms of Whitted's model under the same names: ambient, diffuse, phong, reflection. The
pigment's transmit scales ambient and diffuse down. POV-Ray counts the camera ray as a level.
"""

import math
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tracer.formulas.vector import Vector
from tracer.kernel.world import prepare
from tracer.scene import Material, Object, Scene, Shape
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon


def available() -> bool:
    return shutil.which("povray") is not None


def write_scene(scene: Scene, depth: int, size: tuple[int, int], min_weight: float = 0.0) -> str:
    """The scene in POV-Ray's language. Each texture is declared once, by a name, and shared by its objects."""
    view = prepare(scene).view(size)
    aspect = size[0] / size[1]
    angle = 2.0 * math.degrees(math.atan(math.hypot(*view.up) * aspect))
    look_at = np.add(view.eye, view.forward)
    parts = [
        "#version 3.7;",
        f"global_settings {{ assumed_gamma 1 max_trace_level {depth + 1} adc_bailout {min_weight!r}",
        f"  ambient_light {_rgb(scene.tracing.ambient)} }}",
        f"background {{ {_rgb(scene.background.color)} }}",
        # POV-Ray's camera is left-handed: its x axis is turned over.
        f"camera {{ location {_v(view.eye)} sky {_v(scene.camera.up)} up y right -{aspect!r}*x",
        f"  angle {angle!r} look_at {_v(look_at)} }}",
    ]
    for light in scene.lights:
        assert light.position is not None
        parts.append(f"light_source {{ {_v(light.position)} {_rgb(light.color)} }}")
    textures: dict[str, str] = {}
    objects = [_object(item, textures) for item in scene.objects]
    parts += [f"#declare {name} = {texture}" for texture, name in textures.items()]
    return "\n".join(parts + objects) + "\n"


def _object(item: Object, textures: dict[str, str]) -> str:
    """One object in POV-Ray's language. A texture that is not in `textures` yet gets a name there."""
    texture = _texture(item.shape, item.material)
    finish = f"texture {{ {textures.setdefault(texture, f'T{len(textures)}')} }}"
    if item.material.transmit > 0.0:
        finish += f" interior {{ ior {item.material.ior!r} }}"
    if item.shape.name not in WRITERS:
        raise TypeError(f"POV-Ray's writer does not know the shape {item.shape.name}: add it to WRITERS")
    name, content = WRITERS[item.shape.name](item.shape)
    return f"{name} {{ {content} {finish} }}"


def _plane(shape: Plane) -> tuple[str, str]:
    unit = np.array(shape.normal) / np.linalg.norm(shape.normal)
    return "plane", f"{_v(unit)}, {float(unit @ shape.point)!r}"


def _cone(shape: Cone) -> tuple[str, str]:
    return "cone", f"{_v(shape.base)}, {shape.base_radius!r}, {_v(shape.apex)}, {shape.apex_radius!r} open"


def _polygon(shape: Polygon) -> tuple[str, str]:
    corners = [*shape.vertices, shape.vertices[0]]
    return "polygon", f"{len(corners)}, {', '.join(map(_v, corners))}"


# For each shape: its name in POV-Ray's language, and its numbers.
WRITERS: dict[str, Callable[[Any], tuple[str, str]]] = {
    "sphere": lambda shape: ("sphere", f"{_v(shape.center)}, {shape.radius!r}"),
    "plane": _plane,
    "polygon": _polygon,
    "triangle": lambda shape: ("triangle", ", ".join(map(_v, shape.vertices))),
    "box": lambda shape: ("box", f"{_v(shape.min)}, {_v(shape.max)}"),
    "cone": _cone,
    "disc": lambda shape: ("disc", f"{_v(shape.center)}, {_v(shape.normal)}, {shape.radius!r}"),
    "mesh": lambda shape: ("mesh", f"{' '.join(_faces(shape))} inside_vector <0.3, 0.9, 0.2>"),
}


def _faces(mesh: Mesh) -> Iterator[str]:
    normals = mesh.smooth()
    if normals is None:
        for face in mesh.placed():
            yield f"triangle {{ {', '.join(map(_v, face))} }}"
    else:
        for face in np.stack([mesh.placed(), normals], axis=2):  # each corner, followed by its normal
            yield f"smooth_triangle {{ {', '.join(map(_v, face.reshape(6, 3)))} }}"


def _texture(shape: Shape, material: Material) -> str:
    opaque = 1.0 - material.transmit or 1.0
    pigment = f"color {_rgb(material.color)} transmit {material.transmit!r}"
    if material.checker:
        assert material.transmit == 0.0
        size = material.checker.size
        pigment = f"checker color {_rgb(material.color)} color {_rgb(material.checker.color)} scale {size!r}"
        if shape.checker_in_plane and (plane := shape.plane()):
            pigment += f" translate {_v(_into_a_cell(plane, size))}"
    shares = {
        "ambient": material.ambient / opaque,
        "diffuse": material.diffuse / opaque,
        "phong": material.specular,
        "phong_size": material.shininess,
        "reflection": material.reflect,
    }
    finish = " ".join(f"{name} {value!r}" for name, value in shares.items())
    return f"texture {{ pigment {{ {pigment} }} finish {{ {finish} }} }}"


def _into_a_cell(plane: tuple[Vector, Vector], size: float) -> np.ndarray:
    """Translation for a checkered plane. POV-Ray's checker is one of cubes: move it along the normal, an axis, so that
    the plane lies in the middle of cubes with an even third number.
    """
    point, normal = plane
    axis = int(np.abs(normal).argmax())
    assert np.count_nonzero(normal) == 1, "only faces along the axes"
    return (point[axis] - 0.5 * size) * np.eye(3)[axis]


def render(
    source: str, size: tuple[int, int], folder: Path, threads: int = 2, options: Sequence[str] = ()
) -> tuple[np.ndarray, float, dict[str, int]]:
    """(linear image (height, width, 3) clipped to 0..1, trace time in seconds, number of rays by kind)."""
    scene, image = folder / "scene.pov", folder / "scene.ppm"
    scene.write_text(source)
    run = subprocess.run(
        [
            "povray", f"+I{scene}", f"+O{image}", f"+W{size[0]}", f"+H{size[1]}", f"+WT{threads}", "-D", "-A", "+FP16",
            "File_Gamma=1.0", *options,
        ],
        capture_output=True,
        text=True,
        cwd=folder,
        check=False,
    )  # fmt: skip
    if run.returncode != 0:
        raise RuntimeError(run.stderr[-2000:])
    seconds = re.search(r"Trace Time:.*\(([\d.]+) seconds\)", run.stderr)
    assert seconds
    counts = {
        kind: int(found.group(1)) if (found := re.search(rf"{label}:\s+(\d+)", run.stderr)) else 0
        for kind, label in (("reflected", "Reflected Rays"), ("refracted", "Refracted Rays"), ("tir", "Total Internal"))
    }
    return read_ppm(image), float(seconds.group(1)), counts


def read_ppm(path: Path) -> np.ndarray:
    """Read a 16-bit PPM file as numbers from 0 to 1."""
    found = re.match(rb"P6\s+(?:#.*\s+)*(\d+)\s+(\d+)\s+(\d+)\s", content := path.read_bytes())
    assert found
    width, height, highest = map(int, found.groups())
    numbers = np.frombuffer(content, ">u2", width * height * 3, found.end())
    return numbers.reshape(height, width, 3) / highest


def _rgb(color: Sequence[float]) -> str:
    return f"rgb {_v(color)}"


def _v(xyz: Sequence[float] | np.ndarray) -> str:
    return "<" + ", ".join(repr(float(value)) for value in xyz) + ">"
