"""The limit of rays of an image, and the limit of rows that follows for each of its trees: image and tree end at the
same ray.
"""

from typing import Any

import numpy as np
import pytest

import tracer
from tests.scenes import MIRROR, ball, plane, world_of
from tracer.image.progressive import MAX_SAMPLES
from tracer.kernel.limits import MAX_NODES, MAX_RAYS, default_max_rays, image_max_nodes
from tracer.scene import Camera, Image, Light, Material

SIZE = (16, 12)
PIXELS = SIZE[0] * SIZE[1]
LAMPS = [Light("near", position=(1.0, 4.0, 4.0)), Light("behind", position=(0.0, -5.0, -3.0))]
GLASS = Material("glass", transmit=0.9, reflect=0.05, diffuse=0.2, ior=1.5)


def balls() -> tracer.World:
    """Glass balls in front of a mirror that an image leaves out of its table, between two lights."""
    mirror = plane((0, 0, -8), (0, 0, 1), MIRROR, "mirror")
    return world_of(
        ball((0, 0, -3), 1, GLASS), ball((0.6, 0.4, -5), 1, GLASS), mirror, lights=LAMPS, background=(0.2, 0.3, 0.4)
    )


def mirrors(ambient: float = 0.0) -> tracer.World:
    """Two mirrors face to face: no path between them ends."""
    material = Material("mirror", reflect=1.0, ambient=ambient, diffuse=ambient)
    camera = Camera(position=(0.5, 0.3, 0.2), look_at=(1.0, 0.35, 0.9), fov=50.0)
    walls = (plane((0, 0, 0), (1, 0, 0), material, "left"), plane((1, 0, 0), (-1, 0, 0), material, "right"))
    return world_of(*walls, lights=LAMPS[:1], background=(0.2, 0.3, 0.4), camera=camera, image=Image(64, 48))


@pytest.mark.parametrize("rows", [1, 8, 20, 60, 200])
@pytest.mark.parametrize("limits", [{"depth": 12}, {"tolerance": 1e-4}, {"missing": 1e-3}], ids=str)
def test_trees_end_where_those_of_the_image_end(limits: dict, rows: int) -> None:
    """Bit for bit, for every pixel, from the same limit of rays of the image; and as many trees are counted."""
    world = balls()
    limits = limits | {"max_rays": PIXELS * rows + PIXELS - 1}  # rounded down
    image = tracer.render(world, SIZE, threads=2, **limits)
    assert image.max_nodes == max(rows, 3)  # at least a hit with its shadow rays
    ended = 0
    for x, y in np.ndindex(*SIZE):
        tree = tracer.trace(world, (x, y), size=SIZE, **limits)
        assert tree.radiance.tobytes() == image.pixels[y, x].tobytes()
        assert tree.max_nodes == image.max_nodes
        ended += tree.is_limited
    assert image.limited == ended
    assert ended > 0 or rows == 200
    assert image.trees == PIXELS


@pytest.mark.parametrize("limits", [{"depth": 10**6}, {"tolerance": 0.0}], ids=str)
@pytest.mark.parametrize("ambient", [0.0, 0.1])
def test_mirrors_face_to_face_end_with_the_limit_of_rays(limits: dict, ambient: float) -> None:
    """Also where a mirror's row gives way to the next one, so that the table stays short: all rays count."""
    world = mirrors(ambient)
    image = tracer.render(world, max_rays=10**6, **limits)
    assert image.max_nodes == 10**6 // (64 * 48) == 325
    assert image.limited == 64 * 48
    assert image.rays["camera"] + image.rays["reflection"] == 64 * 48 * (325 // 2)
    assert 0.5 * 10**6 <= 2 * (image.rays["camera"] + image.rays["reflection"]) <= 10**6
    tree = tracer.trace(world, (7, 5), max_rays=10**6, **limits)
    assert len(tree) == 2 * (325 // 2)
    assert tree.radiance.tobytes() == image.pixels[5, 7].tobytes()
    assert "stopped at the limit of 325 rays" in tree.to_text()


def test_samples_share_the_limit() -> None:
    """The most samples that a pixel can get count, also where it gets fewer."""
    world = balls()
    limits: dict[str, Any] = {"depth": 12, "max_rays": PIXELS * 80}
    image = tracer.render(world, SIZE, samples=4, **limits)
    assert image.max_nodes == 20
    assert image.trees == 4 * PIXELS >= image.limited > 0
    x, y = 8, 6
    terms = [tracer.trace(world, (x, y), size=SIZE, sample=k, samples=4, **limits) for k in range(4)]
    assert image.pixels[y, x].tolist() == (np.sum([term.radiance for term in terms], axis=0) / 4.0).tolist()
    assert any(term.is_limited for term in terms)
    adaptive = tracer.render(world, SIZE, samples=8, until_error=0.05, **limits)
    assert adaptive.max_nodes == 10
    assert adaptive.counts is not None
    assert adaptive.limited <= adaptive.trees == adaptive.counts.sum() < 8 * PIXELS


def test_limits_without_options_do_not_depend_on_the_samples() -> None:
    world = balls()
    for width, height, rows in ((64, 48, 10**6), (640, 480, 32552), (1920, 1080, 4822), (16384, 16384, 1000)):
        assert {image_max_nodes(world, width * height, samples) for samples in (1, 7, MAX_SAMPLES)} == {rows}
    image = tracer.render(world, SIZE, samples=2, until_seconds=0.01)
    assert (image.max_rays, image.max_nodes) == (2 * MAX_RAYS, MAX_NODES)
    assert default_max_rays(16384 * 16384) == 1000 * 16384 * 16384
    assert tracer.trace(world, ray=((0, 0, 5), (0, 0, -1))).max_nodes == MAX_NODES


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ({"max_rays": 0}, "max_rays must be a whole number >= 1, got 0"),
        ({"max_rays": 1.5}, "max_rays must be a whole number >= 1, got 1.5"),
        ({"max_rays": 9, "max_nodes": 9}, "not both"),
        ({"tolerance": 0.1, "missing": 0.1}, "not both"),
        ({"missing": -1.0}, "missing must be a number >= 0, got -1.0"),
        ({"missing": float("nan")}, "missing must be a number >= 0, got nan"),
    ],
)
def test_other_limits_are_refused(limits: dict, said: str) -> None:
    world = balls()
    for call in (lambda: tracer.render(world, SIZE, **limits), lambda: tracer.trace(world, (3, 4), **limits)):
        with pytest.raises(ValueError, match=said):
            call()
