"""Group L: rays that a scene does not need are not traced: exact counts of an image's rays."""

from collections.abc import Iterator, Sequence

from tracer.image.render import render
from tracer.kernel.world import World, prepare
from tracer.measure.check.case import Reading, case, exactly
from tracer.measure.check.scenes import MATTE, MIRROR, box, glass, path, plane
from tracer.scene import Camera, Light, Material, Object, Scene, Tracing

SIZE = (16, 12)
PIXELS = SIZE[0] * SIZE[1]
KINDS = ("camera", "reflection", "refraction", "tir", "shadow")


def view(*objects: Object, lights: Sequence[Light] = (), model: str = "whitted", inside: bool = False) -> World:
    """A view from above in which the floor y = 0 fills the image; or from inside a block."""
    eye = (0.0, 0.5, 0.0) if inside else (0.0, 4.0, 0.0)
    camera = Camera(position=eye, look_at=(0.1, 0.0, 0.0), up=(0.0, 0.0, 1.0), fov=20.0)
    return prepare(Scene(tuple(objects), tuple(lights), camera, tracing=Tracing(model=model)))


def counts(world: World, depth: int, **expected: int) -> Iterator[Reading]:
    """The number of rays of each kind; 0 for those not named, and one camera ray per pixel."""
    rays = render(world, size=SIZE, depth=depth, threads=1).rays
    for kind in KINDS:
        exact = PIXELS if kind == "camera" else expected.get(kind, 0)
        yield exactly(f"{kind} rays", exact, int(rays[kind]))


def floor(material: Material) -> Object:
    return plane((0, 0, 0), (0, 1, 0), material, "floor")


@case("L1", "a matte scene with one light: one ray and one shadow ray a pixel")
def matte() -> Iterator[Reading]:
    """A tracer that sends every kind of ray from every hit, and multiplies by 0 afterwards, does the work of a tree for
    a picture that needs none: with two children per hit, 63 rays per pixel at depth 5, of which 62 count for
    nothing.
    """
    yield from counts(view(floor(MATTE), lights=[Light("lamp", position=(1, 5, 1))]), 5, shadow=PIXELS)


@case("L2", "no light: no shadow ray")
def dark() -> Iterator[Reading]:
    """A shadow ray tests whether a light is visible. Without lights there is nothing to test. A loop that always sends
    one would double the work for a black picture.
    """
    yield from counts(view(floor(MATTE)), 5)


@case("L3", "a mirror, equal indices, total internal reflection: one ray each")
def one_child() -> Iterator[Reading]:
    """A surface that always splits sends a ray of weight 0 along with the other. With one such ray per hit the tree
    doubles at every level: a thousand rays at depth ten instead of ten.
    """
    world = view(floor(MIRROR))
    yield exactly(
        "a mirror: reflection rays", PIXELS, int(render(world, size=SIZE, depth=5, threads=1).rays["reflection"])
    )
    world = view(floor(glass(1.0)), model="fresnel")
    rays = render(world, size=SIZE, depth=5, threads=1).rays
    yield exactly("equal indices: refraction rays", PIXELS, int(rays["refraction"]))
    yield exactly("equal indices: reflection rays", 0, int(rays["reflection"]))
    # From inside glass, 53 degrees off the normal: beyond the critical angle of 42.
    block = prepare(Scene((box((-9, -1, -9), (9, 1, 9), glass(1.5)),), tracing=Tracing(model="fresnel")))
    tree = path(block, (0, 0, 0), (0.8, 0.6, 0), depth=1)
    yield exactly("beyond the critical angle: rays sent out", 1, len(tree.children[0]))
    yield exactly("beyond the critical angle: their kind", "tir", tree.kind(1))


@case("L5", "a light behind the surface: no shadow ray")
def unlit() -> Iterator[Reading]:
    """If n.l is below 0 the light adds nothing, whatever stands in its way. Searching the scene before testing that
    wastes about half of all shadow rays on a closed body.
    """
    yield from counts(view(floor(MATTE), lights=[Light("under", position=(0, -5, 0))]), 5)
    both = [Light("under", position=(0, -5, 0)), Light("over", position=(1, 5, 1))]
    for reading in counts(view(floor(MATTE), lights=both), 5, shadow=PIXELS):
        if reading.setting == "shadow rays":
            yield exactly("a light on either side: shadow rays", PIXELS, reading.got)
