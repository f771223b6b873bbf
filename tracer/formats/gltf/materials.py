"""The numbers of a glTF material as those of our materials. `docs/meshes.md` has a table of the fields."""

from typing import Any

from tracer.formats.gltf.document import Item
from tracer.formats.mesh_part import AMBIENT
from tracer.formats.notes import Notes
from tracer.formats.source import Fault
from tracer.printable import printable
from tracer.scene import Material

METAL_MIRROR = 0.7  # reflection coefficient of a smooth metal
IOR = 1.5  # without KHR_materials_ior


class Materials:
    """The materials of a document. Each is read when the first face uses it."""

    def __init__(self, document: Item, notes: Notes) -> None:
        self.items = document.items("materials")
        self.notes = notes
        self.found: dict[int, tuple[Material, bool]] = {}

    def get(self, number: int, place: str) -> tuple[Material, bool]:
        """(material, whether it is a thin sheet). Raises Fault, also for numbers that no material has."""
        if number >= len(self.items):
            raise Fault(f"{place} must be from 0 to {len(self.items) - 1}, got {number}")
        if number not in self.found:
            self.found[number] = material_of(self.items[number], number, self.notes)
        return self.found[number]


def textures_in(value: Any) -> int:
    """The number of textures of a material, those of its extensions included."""
    if not isinstance(value, dict):
        return 0
    return sum(key.endswith("Texture") + textures_in(part) for key, part in value.items())


def material_of(item: Item, number: int, notes: Notes) -> tuple[Material, bool]:
    """(material, whether it is a thin sheet)."""
    name = item.text("name") or f"material {number}"
    pbr, extensions = item.item("pbrMetallicRoughness"), item.item("extensions")
    r, g, b, alpha = pbr.numbers("baseColorFactor", [1.0, 1.0, 1.0, 1.0], least=0.0)
    metal, rough = pbr.number("metallicFactor", 1.0, 0.0, 1.0), pbr.number("roughnessFactor", 1.0, 0.0, 1.0)
    notes.count("textures are not shown", textures_in(item.value))
    transmission = extensions.item("KHR_materials_transmission")
    volume = extensions.item("KHR_materials_volume")
    clear = transmission.number("transmissionFactor", 0.0, 0.0, 1.0) * (1.0 - metal)  # metals let no light through
    thin = volume.number("thicknessFactor", 0.0, 0.0) == 0.0
    cover = 1.0  # the share of the surface; the rest lets light through
    if item.text("alphaMode") == "BLEND":
        cover = min(1.0, alpha)
    elif item.text("alphaMode") == "MASK":
        notes.name('materials with alphaMode "MASK" are shown opaque', name)
    coloured = len({r, g, b}) > 1
    if clear > 0.0 and volume.has("attenuationDistance"):
        notes.name("glass that absorbs light along its way (attenuation) is shown clear", name)
    if clear > 0.0 and (coloured or rough > 0.0):
        notes.name("coloured or rough glass is shown clear", name)
    smooth = 1.0 - rough
    color, ambient, diffuse = (r, g, b), AMBIENT * (1.0 - clear), (1.0 - METAL_MIRROR * metal) * (1.0 - clear)
    specular, reflect = 0.5 * smooth, METAL_MIRROR * metal * smooth
    if extensions.has("KHR_materials_unlit"):
        ambient, diffuse, specular, reflect = 1.0, 0.0, 0.0, 0.0
    if reflect > 0.0 and coloured:
        notes.name("coloured metal mirrors in grey", name)
    strength = extensions.item("KHR_materials_emissive_strength").number("emissiveStrength", 1.0, 0.0)
    emission = [strength * value for value in item.numbers("emissiveFactor", [0.0, 0.0, 0.0], least=0.0)]
    if max(emission) > 0.0:
        notes.name("materials that emit light have the colour of their emission, and light no other surface", name)
        diffuse *= (r + g + b) / 3.0
        ambient = max(emission)
        color = (emission[0] / ambient, emission[1] / ambient, emission[2] / ambient)
    transmit = 1.0 - cover * (1.0 - clear)
    return (
        Material(
            name=printable(name),
            color=color,
            ambient=cover * ambient,
            diffuse=cover * diffuse,
            specular=cover * specular,
            shininess=1.0 + 200.0 * smooth**2,
            reflect=cover * reflect,
            transmit=transmit,
            ior=extensions.item("KHR_materials_ior").number("ior", IOR) or IOR,
        ),
        transmit > 0.0 and thin,
    )
