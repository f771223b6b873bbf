"""The numbers of a glTF material as those of our materials. `docs/meshes.md` has a table of the fields."""

from tracer.formats.gltf.document import Item
from tracer.formats.mesh_part import AMBIENT
from tracer.formats.notes import Notes
from tracer.scene import Material

METAL_MIRROR = 0.7  # reflection coefficient of a smooth metal
IOR = 1.5  # without KHR_materials_ior

TEXTURES = ("normalTexture", "occlusionTexture", "emissiveTexture")
PBR_TEXTURES = ("baseColorTexture", "metallicRoughnessTexture")


def material_of(item: Item, number: int, notes: Notes) -> tuple[Material, bool]:
    """(material, whether it is a thin sheet)."""
    name = item.text("name") or f"material {number}"
    pbr, extensions = item.item("pbrMetallicRoughness"), item.item("extensions")
    r, g, b, alpha = pbr.numbers("baseColorFactor", [1.0, 1.0, 1.0, 1.0])
    metal, rough = pbr.number("metallicFactor", 1.0, 0.0, 1.0), pbr.number("roughnessFactor", 1.0, 0.0, 1.0)
    textures = sum(pbr.has(key) for key in PBR_TEXTURES) + sum(item.has(key) for key in TEXTURES)
    notes.count("textures are not shown", textures)
    transmission = extensions.item("KHR_materials_transmission")
    volume = extensions.item("KHR_materials_volume")
    transmit = transmission.number("transmissionFactor", 0.0, 0.0, 1.0)
    thin = volume.number("thicknessFactor", 0.0, 0.0) == 0.0
    if volume.has("attenuationDistance"):
        notes.name("glass that absorbs light along its way (attenuation) is shown clear", name)
    if item.text("alphaMode") == "BLEND":
        transmit = max(transmit, 1.0 - alpha)
    elif item.text("alphaMode") == "MASK":
        notes.name('materials with alphaMode "MASK" are shown opaque', name)
    if transmit > 0.0 and (len({r, g, b}) > 1 or rough > 0.0):
        notes.name("coloured or rough glass is shown clear", name)
    smooth = 1.0 - rough
    color, ambient, diffuse = (r, g, b), AMBIENT * (1.0 - transmit), (1.0 - METAL_MIRROR * metal) * (1.0 - transmit)
    specular, reflect = 0.5 * smooth, METAL_MIRROR * metal * smooth
    if extensions.has("KHR_materials_unlit"):
        ambient, diffuse, specular, reflect = 1.0, 0.0, 0.0, 0.0
    strength = extensions.item("KHR_materials_emissive_strength").number("emissiveStrength", 1.0, 0.0)
    emission = [strength * value for value in item.numbers("emissiveFactor", [0.0, 0.0, 0.0])]
    if max(emission) > 0.0:
        notes.name("materials that emit light have the colour of their emission, and light no other surface", name)
        diffuse *= (r + g + b) / 3.0
        ambient = max(emission)
        color = (emission[0] / ambient, emission[1] / ambient, emission[2] / ambient)
    return (
        Material(
            name=name,
            color=color,
            ambient=ambient,
            diffuse=diffuse,
            specular=specular,
            shininess=1.0 + 200.0 * smooth**2,
            reflect=reflect,
            transmit=transmit,
            ior=extensions.item("KHR_materials_ior").number("ior", IOR) or IOR,
        ),
        transmit > 0.0 and thin,
    )
