"""Small files after public bug reports of other programs, each with its right answer (`cases/`)."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

import tracer
from tracer.scene import Material, Object, Scene
from tracer.shapes.box import Box
from tracer.shapes.mesh import Mesh

CASES = Path(__file__).parent / "cases"
UNIT = ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0])
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Right:
    """The right answer for a file: its geometry, its materials, and what is noted."""

    file: str
    faces: int = 12
    volume: float = 1.0
    area: float = 6.0
    bounds: tuple[list[float], list[float]] = UNIT
    names: tuple[str, ...] | None = None
    colors: tuple[Vector, ...] | None = None
    transmit: tuple[float, ...] | None = None
    ior: tuple[float, ...] | None = None
    thin: tuple[bool, ...] | None = None
    notes: tuple[str, ...] = field(default=())


TWO = {"faces": 24, "volume": 2.0, "area": 12.0, "bounds": ([0, 0, 0], [4, 1, 1])}
GLASS = {"names": ("red paint", "glass"), "transmit": (0.0, 0.9), "ior": (1.0, 1.5)}
RED = (0.9, 0.1, 0.1)

RIGHT = [
    Right("01-obj-negative-interleaved/two.obj", **TWO),
    Right("02-obj-bom/bom.obj"),
    Right("03-obj-concave/L.obj", 4, 0.0, 3.0, ([0, 0, 0], [2, 2, 0])),
    Right("04-mtl-kd1/m.obj", colors=((0.5, 0.5, 0.5),)),
    Right("04-mtl-kdcomment/m.obj", colors=((0.5, 0.2, 0.1),), transmit=(0.5,)),
    Right("05-mtllib-backslash/two.obj", **TWO, **GLASS, colors=(RED, (0.0, 0.0, 0.0))),
    Right(
        "05-mtllib-missing/two.obj",
        **TWO,
        names=("red paint", "glass"),
        notes=(
            'two.obj: material libraries that were not found: "gone.mtl"',
            'two.obj: materials that were not found, shown as clay: "red paint", "glass"',
        ),
    ),
    Right("05-mtllib-two-lines/two.obj", **TWO, names=("red", "glass"), transmit=(0.0, 0.9), ior=(1.0, 1.5)),
    Right("05-one-bad-one-good/two.obj", **TWO, **GLASS, colors=((0.9, 0.9, 0.9), (0.0, 0.0, 0.0))),
    Right("05-usemtl-comment/two.obj", **TWO, **GLASS),
    Right("06-degenerate/t.obj", notes=("t.obj: faces without area are left out: 2",)),
    Right("06-inline-comment/t.obj"),
    Right("06-v-colour/t.obj", notes=("t.obj: vertex colours are not shown: 8",)),
    Right("07-glb-mirrored/m.glb", bounds=([-1, 0, 0], [0, 1, 1])),
    Right("08-glb-thin-transmission/m.glb", transmit=(0.9,), thin=(True,)),
    Right(
        "09-glb-unnamed-materials/m.glb",
        **TWO,
        transmit=(0.9, 0.0),
        colors=((1.0, 1.0, 1.0), (1.0, 0.0, 0.0)),
        names=("material 0", "material 1"),
    ),
    Right("11-glb-sparse-nobase/m.glb"),
    Right("12-glb-quantized/m.glb"),
    Right("14-glb-fan/m.glb", 2, 0.0, 1.0, ([0, 0, 0], [1, 1, 0])),
    Right("15-stl-ascii-latin1/c.stl", names=("Würfel",)),
    Right("16-ply-colours/c.ply", notes=("c.ply: vertex colours are not shown: 8",)),
    Right("16-ply-edge-first/c.ply", notes=('c.ply: elements "edge" are not read: 1',)),
    Right("17-inverted-glass/s.toml", ior=(1.5,), notes=('"cube": wound inside out in the file, and turned',)),
    Right("31-overlap-mesh/s.toml", 24, 2.0, 12.0, ([0, 0, 0], [1.5, 1, 1])),
]


@pytest.mark.parametrize("right", RIGHT, ids=lambda right: right.file)
def test_file_is_shown_as_it_is(right: Right) -> None:
    world = tracer.prepare(tracer.load(CASES / right.file))
    items = world.scene.objects
    meshes = [item.shape for item in items if isinstance(item.shape, Mesh)]
    corners = np.concatenate([mesh.placed() for mesh in meshes])
    a, b, c = np.moveaxis(corners, 1, 0)
    across = np.cross(b - a, c - a)
    assert len(corners) == right.faces
    assert (a * np.cross(b, c)).sum() / 6.0 == pytest.approx(right.volume, rel=2.0**-50, abs=2.0**-50)
    assert np.sqrt((across * across).sum(axis=1)).sum() / 2.0 == pytest.approx(right.area, rel=2.0**-50, abs=0.0)
    assert corners.min(axis=(0, 1)).tolist() == right.bounds[0]
    assert corners.max(axis=(0, 1)).tolist() == right.bounds[1]
    assert all(mesh.is_closed() for mesh in meshes) == (right.volume > 0.0)
    for found, wanted in (
        ([item.name for item in items], right.names),
        ([item.material.color for item in items], right.colors),
        ([item.material.ior for item in items], right.ior),
        ([item.thin for item in items], right.thin),
    ):
        assert wanted is None or tuple(found) == wanted
    if right.transmit is not None:
        assert [item.material.transmit for item in items] == pytest.approx(right.transmit, rel=2.0**-51, abs=0.0)
    assert tuple(world.notes) == right.notes


@pytest.mark.parametrize(
    ("file", "said"),
    [
        (
            "04-mtl-tfspec/m.obj",
            'm.obj: m.mtl: line 4: material "a": Tf must be r g b or xyz x y z, got a spectral curve',
        ),
        ("09-glb-list-ext/m.glb", "m.glb: materials[0].extensions must be an object, got a list"),
        (
            "13-glb-draco/m.glb",
            "m.glb: the file needs the extension KHR_draco_mesh_compression, which is not",
        ),
        ("15-stl-count-too-big/c.stl", "c.stl: must have 13 triangles, as its header says, got 12"),
    ],
)
def test_what_cannot_be_shown_is_one_line(file: str, said: str) -> None:
    with pytest.raises(tracer.SceneError) as caught:
        tracer.load(CASES / file)
    (line,) = caught.value.faults
    assert said in line


@pytest.mark.parametrize("file", ["40-nff-bom/a.nff", "41-toml-bom/a.toml"])
def test_byte_order_mark_is_no_part_of_the_text(file: str, tmp_path: Path) -> None:
    data = (CASES / file).read_bytes()
    bare = tmp_path / Path(file).name
    bare.write_bytes(data.removeprefix(b"\xef\xbb\xbf"))
    assert data[:3] == b"\xef\xbb\xbf"
    assert tracer.load(CASES / file).objects == tracer.load(bare).objects


def test_point_in_the_notch_of_a_concave_face_is_not_covered() -> None:
    world = tracer.prepare(tracer.load(CASES / "03-obj-concave/L.obj"))
    for x, y, covered in ((1.5, 1.5, False), (0.5, 1.5, True), (1.5, 0.5, True), (0.5, 0.5, True)):
        tree = tracer.trace(world, ray=((x, y, 3.0), (0.0, 0.0, -1.0)), depth=0)
        assert (tree.nodes["object"][0] == 0) == covered


def test_inverted_glass_is_glass_inside() -> None:
    world = tracer.prepare(tracer.load(CASES / "17-inverted-glass/s.toml"))
    tree = tracer.trace(world, ray=((-3.0, 0.3, 0.4), (1.0, 0.05, 0.02)), depth=1)
    assert [(n["n1"], n["n2"]) for n in tree.nodes if np.isfinite(n["n2"])] == [(1.0, 1.5), (1.5, 1.0)]


def test_thin_sheets_do_not_bend_light() -> None:
    world = tracer.prepare(tracer.load(CASES / "08-glb-thin-transmission/m.glb"))
    tree = tracer.trace(world, ray=((-3.0, 0.3, 0.4), (1.0, 0.05, 0.02)), depth=1)
    camera, through = (tree.nodes["direction"][i] for i in (0, tree.children[0][-1]))
    assert camera.tolist() == through.tolist()


def test_overlapping_shells_of_one_file_are_a_union_as_two_boxes_are() -> None:
    mesh = tracer.prepare(tracer.load(CASES / "31-overlap-mesh/s.toml"))
    glass = Material("glass", transmit=1.0, ior=1.5)
    boxes = (Box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), Box((0.5, 0.0, 0.0), (1.5, 1.0, 1.0)))
    pair = tracer.prepare(Scene(tuple(Object(box, glass, "pair") for box in boxes)))
    ray = ((-3.0, 0.3, 0.4), (1.0, 0.05, 0.02))
    ours, theirs = (tracer.trace(world, ray=ray, depth=6).nodes for world in (mesh, pair))
    for name in ("n1", "n2", "kind"):
        np.testing.assert_array_equal(ours[name], theirs[name])
    assert ours["point"] == pytest.approx(theirs["point"], abs=2.0**-49, nan_ok=True)
    last = ours["point"][-2]
    assert last == pytest.approx((1.5, 0.49996, 0.47998), abs=1e-5)
    assert np.nanmax(ours["n2"][:-2]) == 1.5


def test_negative_radius_inside_a_ball_is_a_cavity() -> None:
    world = tracer.prepare(tracer.load(CASES / "28-nff-negative-radius/s.nff"))
    tree = tracer.trace(world, ray=((0.0, 0.0, 5.0), (0.0, 0.0, -1.0)), depth=5)
    passed = [(row["n1"], row["n2"]) for row in tree.nodes if np.isfinite(row["n2"])]
    assert passed == [(1.0, 1.5), (1.5, 1.0), (1.0, 1.5), (1.5, 1.0)]
    assert world.notes == []
