"""The tables of docs/meshes.md, field by field: MTL and glTF materials as numbers of our materials."""

from pathlib import Path
from typing import Any

import pytest

import tracer
from tests.tracer.formats.test_meshes import glb, obj, write
from tracer.formats.mesh_part import AMBIENT, CLAY
from tracer.scene import Object

U = 2.0**-53


def from_mtl(tmp_path: Path, text: str) -> tuple[Object, list[str]]:
    write(tmp_path / "a.mtl", f"newmtl a\n{text}\n")
    world = tracer.prepare(tracer.load(write(tmp_path / "a.obj", obj("mtllib a.mtl\nusemtl a"))))
    return world.scene.objects[0], world.notes


def agrees(item: Object, wanted: dict[str, Any]) -> None:
    for name, value in wanted.items():
        found = item.thin if name == "thin" else getattr(item.material, name)
        assert found == pytest.approx(value, rel=8 * U, abs=0.0), name


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("Kd 0.2 0.4 0.6", {"color": (0.2, 0.4, 0.6), "diffuse": 1.0, "ambient": AMBIENT, "transmit": 0.0, "ior": 1.0}),
        ("Kd 0.3", {"color": (0.3, 0.3, 0.3)}),
        ("Kd xyz 0.4124 0.2126 0.0193", {"color": (0.99998, 0.00001, 0.0)}),
        ("Kd 1\nKs 0.2 0.4 0.6", {"specular": 0.4, "reflect": 0.0}),
        ("Kd 1\nKs 0.4\nillum 1", {"specular": 0.0}),
        ("Kd 1\nKs 0.4\nNs 96", {"shininess": 96.0}),
        ("Kd 1\nNs 0", {"shininess": 1.0}),
        ("Kd 1\nd 0.25", {"transmit": 0.75, "diffuse": 0.25, "ambient": 0.25 * AMBIENT}),
        ("Kd 1\nTr 0.75", {"transmit": 0.75}),
        ("Kd 1\nd 0.25\nTr 0.25", {"transmit": 0.75}),
        ("Kd 1\nd 0.5\nNi 1.33", {"ior": 1.33}),
        ("Kd 1\nTf 0.5\nillum 6", {"transmit": 0.5}),
        ("Kd 1\nTf 0.5\nd 0.5\nillum 7", {"transmit": 0.25}),
        ("Kd 1\nTf 0.5\nillum 4", {"transmit": 0.0}),
        ("Kd 1\nKs 0.4\nillum 3", {"reflect": 0.4}),
        ("Kd 1\nKs 0.4\nd 0.5\nillum 7", {"reflect": 0.2}),
        ("Kd 1\nKs 0.4\nillum 8", {"reflect": 0.0}),
        ("Kd 0.5\nKs 0.4\nillum 0", {"ambient": 1.0, "diffuse": 0.0, "specular": 0.0}),
        ("d 0.1\nNi 1.5", {"color": CLAY.color, "transmit": 0.9, "ior": 1.5}),
    ],
)
def test_mtl_field(text: str, wanted: dict[str, Any], tmp_path: Path) -> None:
    if "xyz" in text:
        found = from_mtl(tmp_path, text)[0].material.color
        assert found == pytest.approx(wanted["color"], abs=1e-3)  # the digits of the matrix in the standard
        return
    agrees(from_mtl(tmp_path, text)[0], wanted)


@pytest.mark.parametrize(
    ("text", "note"),
    [
        ("d 0.5", "without Kd"),
        ("Kd 1\nKs 0.2 0.4 0.6", "coloured Ks is read as its mean"),
        ("Kd 1\nd 0.5\nTr 0.6", "contradict each other: d counts"),
        ("Kd 1\nd 0.5\nillum 7", 'need the model "fresnel"'),
        ("Kd 1\nillum 8", "reflect a picture"),
        ("Kd 255 128 0", "reflect more light than they get"),
        ("Kd 1\nKa 1 1 1", "Ka is not read"),
        ("Kd 1\nmap_Kd a.png", "textures are not shown: 1"),
        ("Kd 1\nd -halo 0.5", "d -halo"),
        ("Kd red\nd 0.5", 'cannot be read are left out: "line 2: Kd red"'),
        ("Kd 1\nsharpness 60", 'statements "sharpness" are not read: 1'),
    ],
)
def test_mtl_note(text: str, note: str, tmp_path: Path) -> None:
    notes = from_mtl(tmp_path, text)[1]
    assert any(note in line for line in notes), notes


def from_gltf(tmp_path: Path, material: dict[str, Any]) -> tuple[Object, list[str]]:
    world = tracer.prepare(tracer.load(write(tmp_path / "a.glb", glb({"name": "a", **material}))))
    return world.scene.objects[0], world.notes


def pbr(**values: Any) -> dict[str, Any]:
    return {"pbrMetallicRoughness": values}


def extension(name: str, **values: Any) -> dict[str, Any]:
    return {**pbr(metallicFactor=0.0), "extensions": {f"KHR_materials_{name}": values}}


STRONG = {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}
CLEAR = {"KHR_materials_transmission": {"transmissionFactor": 1.0}}
THICK = {"KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_volume": {"thicknessFactor": 1.0}}


@pytest.mark.parametrize(
    ("material", "wanted"),
    [
        ({}, {"color": (1.0, 1.0, 1.0), "diffuse": 0.3, "reflect": 0.0, "specular": 0.0, "shininess": 1.0}),
        (pbr(baseColorFactor=[0.2, 0.4, 0.6, 1.0], metallicFactor=0.0), {"color": (0.2, 0.4, 0.6), "diffuse": 1.0}),
        (pbr(roughnessFactor=0.0), {"reflect": 0.7, "specular": 0.5, "shininess": 201.0}),
        (pbr(metallicFactor=0.0, roughnessFactor=0.5), {"reflect": 0.0, "specular": 0.25, "shininess": 51.0}),
        (extension("transmission", transmissionFactor=0.9), {"transmit": 0.9, "thin": True, "ior": 1.5}),
        ({**pbr(metallicFactor=0.0), "extensions": THICK}, {"transmit": 0.9, "thin": False, "diffuse": 0.1}),
        (extension("ior", ior=1.7), {"ior": 1.7}),
        (extension("unlit"), {"ambient": 1.0, "diffuse": 0.0, "reflect": 0.0}),
        ({**pbr(baseColorFactor=[1, 1, 1, 0.25]), "alphaMode": "BLEND"}, {"transmit": 0.75, "thin": True}),
        ({**pbr(baseColorFactor=[1, 1, 1, 0.25]), "alphaMode": "MASK"}, {"transmit": 0.0}),
        # A metal lets no light through, and a surface that is not there neither reflects nor shines.
        ({"extensions": CLEAR}, {"transmit": 0.0, "thin": False, "diffuse": 0.3}),
        ({**pbr(metallicFactor=0.5, roughnessFactor=0.0), "extensions": CLEAR}, {"transmit": 0.5, "reflect": 0.35}),
        (
            {**pbr(baseColorFactor=[1, 1, 1, 0], roughnessFactor=0.0), "alphaMode": "BLEND"},
            {"transmit": 1.0, "reflect": 0.0, "specular": 0.0, "ambient": 0.0, "diffuse": 0.0},
        ),
        (
            {**pbr(baseColorFactor=[1, 0, 0, 0.25]), "alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}},
            {"color": (1.0, 0.0, 0.0), "ambient": 0.25, "transmit": 0.75},
        ),
        (
            {
                "emissiveFactor": [1.0, 0.5, 0.0],
                "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}},
            },
            {"color": (1.0, 0.5, 0.0), "ambient": 4.0},
        ),
    ],
)
def test_gltf_field(material: dict[str, Any], wanted: dict[str, Any], tmp_path: Path) -> None:
    agrees(from_gltf(tmp_path, material)[0], wanted)


@pytest.mark.parametrize(
    ("material", "note"),
    [
        ({"emissiveFactor": [1, 0, 0]}, "emit light"),
        ({"alphaMode": "MASK"}, 'alphaMode "MASK"'),
        ({**pbr(baseColorTexture={"index": 0}), "normalTexture": {"index": 1}}, "textures are not shown: 2"),
        (extension("transmission", transmissionTexture={"index": 0}), "textures are not shown: 1"),
        (pbr(baseColorFactor=[1.0, 0.7, 0.1, 1.0], roughnessFactor=0.0), "coloured metal mirrors in grey"),
    ],
)
def test_gltf_note(material: dict[str, Any], note: str, tmp_path: Path) -> None:
    notes = from_gltf(tmp_path, material)[1]
    assert any(note in line for line in notes), notes
