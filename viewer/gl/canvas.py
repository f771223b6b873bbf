"""What panels share of the GPU: the 3D stage and the picture's texture, made anew only when something has changed."""

import time
from typing import NamedTuple

import moderngl
import numpy as np
from imgui_bundle import imgui

from tracer.kernel.entry import Area
from tracer.tree.raytree import RayTree
from viewer.base.colormap import colored
from viewer.figures.ray_lines import RayLine, ray_lines
from viewer.gl.magnified import NEAR, Place, magnified
from viewer.gl.stage import ImagePlane, Stage
from viewer.gl.stage_lines import StageLines, frustum_lines, glass_edges, image_plane, normal_lines, style_rays
from viewer.session.progressive import Picture
from viewer.session.session import Session

REFRESH = 0.4  # seconds between the states of an unfinished image that the 3D view shows, at least
RARELY = 10.0  # times the frame that draws it anew: else a slow one would be every frame


class Seen(NamedTuple):
    """A texture and the corners of its place on the screen."""

    texture: moderngl.Texture
    first: tuple[float, float]
    end: tuple[float, float]


class Canvas:
    def __init__(self, ctx: moderngl.Context, session: Session) -> None:
        self.ctx = ctx
        self.session = session
        self.stage = Stage(ctx)
        self.image: moderngl.Texture | None = None
        # As drawn last, for a click to hit: rays in the 3D view; the image's left, top and size of a pixel; tree nodes.
        self.lines: list[RayLine] = []
        self.image_place: tuple[float, float, float] = (0.0, 0.0, 1.0)
        self.nodes: dict[int, tuple[float, float]] = {}
        self.stage_place: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)  # left, top, width, height
        self.told: tuple[RayTree, int] | None = None  # which ray the panel of numbers was about
        self.map_image: moderngl.Texture | None = None
        self._mapped: object = None  # what of an image that converges is in that texture
        self._near: Seen | None = None
        self._near_key: object = None
        self._sent: tuple[Picture | None, int] = (None, 0)  # the picture in the texture, and how many of its tiles
        self._world: object = None
        self._theme: object = None
        self._drawn_key: object = None
        self._image_in_view: object = None
        self._picture: Picture | None = None  # that an unfinished state was asked of last
        self._refreshed = 0.0
        self._drawn_anew = False  # the 3D view, in this frame
        self._cost = 0.0  # seconds of the last frame that did
        self._plane: np.ndarray | None = None

    def picture(self) -> moderngl.Texture | None:
        """The rendered image as far as it is; its first row is the picture's top."""
        shown = self.session.image.picture
        if shown is None:
            return None
        height, width = shown.shown.shape[:2]
        if self.image is None or self.image.size != (width, height):
            if self.image:
                self.image.release()
            self.image = self.ctx.texture((width, height), 4)
            self._sent = (None, 0)
        before, count = self._sent
        if shown is not before:
            self._sent = (shown, len(shown.tiles))  # tiles that come while this is sent are sent again
            self.image.write(shown.shown)
        elif tiles := shown.tiles[count:]:
            _send(self.image, shown.shown, tiles)
            self._sent = (shown, count + len(tiles))
        return self.image

    def seen(self, place: Place) -> Seen | None:
        """What stands in the image's panel: the rendered image or a map of it; near by, its pixels as squares."""
        shown = self.session.image.picture
        if shown is None:
            return None
        if place.scale < NEAR:
            texture = self._map() or self.picture()
            if texture is None:
                return None
            width, height = (place.scale * side for side in texture.size)
            return Seen(texture, (place.left, place.top), (place.left + width, place.top + height))
        key = (place, self._map_key(), shown, len(shown.tiles))
        if key != self._near_key:
            self._near_key = key
            pixels = self._map_pixels()
            found = magnified(shown.shown if pixels is None else pixels, place)
            self._near = self._near_at(*found) if found else None
        return self._near

    def _near_at(self, pixels: np.ndarray, left: int, top: int) -> Seen:
        height, width = pixels.shape[:2]
        if self._near and self._near.texture.size == (width, height):
            texture = self._near.texture
            texture.write(pixels)
        else:
            if self._near:
                self._near.texture.release()
            texture = self.ctx.texture((width, height), 4, pixels)
        return Seen(texture, (left, top), (left + width, top + height))

    def _map_key(self) -> object:
        """What the map depends on: it changes from round to round."""
        run = self.session.convergence.current
        if not run or self.session.convergence.shows == "image":
            return None
        return (run, self.session.convergence.shows, len(run.points), run.picture and run.picture.finished)

    def _map(self) -> moderngl.Texture | None:
        """Each pixel's error, or its samples; None where the image itself is to be seen."""
        key = self._map_key()
        if key != self._mapped:
            self._mapped = key
            pixels = self._map_pixels()
            if self.map_image:
                self.map_image.release()
            self.map_image = None if pixels is None else self.ctx.texture(pixels.shape[1::-1], 4, pixels)
        return self.map_image

    def _map_pixels(self) -> np.ndarray | None:
        state = self.session.convergence
        values = state.map
        return None if values is None else colored(values, state.shows)

    def view3d(self, size: tuple[int, int], scale: float) -> moderngl.Texture:
        """The 3D view, `size` in pixels, `scale` pixels a logical one; bottom row first, as GL has it."""
        session = self.session
        image = self.picture() if session.shown.camera else None
        key = self._key(size, scale)
        if key != self._drawn_key:
            self._set_world()
            self._set_lines()
            plane = ImagePlane(self._plane, image) if image is not None and self._plane is not None else None
            self.stage.draw(session.orbit, session.theme, size, scale, plane)
            self._drawn_key = key
            self._drawn_anew = True
        return self.stage.target.texture

    def frame_took(self, seconds: float) -> None:
        if self._drawn_anew:
            self._cost = seconds
        self._drawn_anew = False

    def _key(self, size: tuple[int, int], scale: float) -> tuple:
        """Everything the 3D view depends on."""
        session = self.session
        orbit, shown = session.orbit, session.shown
        eye = (orbit.azimuth, orbit.elevation, orbit.distance, *orbit.target)
        picture = self._image_state() if shown.camera else None
        switches = (frozenset(shown.kinds), shown.camera, shown.normals)
        return (
            size, scale, eye, picture, switches, session.world, session.tree, session.selected,
            session.theme.name,
        )  # fmt: skip

    def _image_state(self) -> object:
        """Which state of the image stands on the image plane: not every tile is worth drawing the scene again."""
        shown = self.session.image.picture
        now = time.monotonic()
        if shown is not self._picture:
            self._picture, self._refreshed = shown, now  # its first tiles can wait, too
        if shown is None or shown.finished or now - self._refreshed > max(REFRESH, RARELY * self._cost):
            self._image_in_view = self._sent
            self._refreshed = now
        return self._image_in_view

    def _set_world(self) -> None:
        session = self.session
        if not session.world:
            return
        if session.world is not self._world:
            self.stage.set_world(session.world, session.frame)
        if (session.world, session.theme) != (self._world, self._theme):
            self.stage.set_edges(glass_edges(session.world, session.frame, session.theme))
        self._world, self._theme = session.world, session.theme

    def _set_lines(self) -> None:
        session = self.session
        marks = []
        self.lines = []
        rays = []
        self._plane = None
        if session.world and session.shown.camera:
            view = session.world.view()
            self._plane = image_plane(view, session.frame, np.zeros(3))
            marks += frustum_lines(view, session.frame, self._plane, session.theme)
        if session.tree:
            rows = len(session.tree)
            self.lines = ray_lines(session.tree, rows, session.frame, session.shown.kinds)
            rays = style_rays(self.lines, session.tree, session.selected, session.theme)
            if session.shown.normals:
                marks += normal_lines(session.tree, rows, session.frame, session.selected, session.theme)
        self.stage.set_lines(StageLines(marks, rays))

    def release(self) -> None:
        self.stage.release()
        for texture in (self.image, self.map_image, self._near and self._near.texture):
            if texture:
                texture.release()


def _send(image: moderngl.Texture, pixels: np.ndarray, tiles: list[Area]) -> None:
    """The rectangle around these tiles, which follow each other by rows: the whole image would take a frame's time."""
    left, top = min(tile.left for tile in tiles), min(tile.top for tile in tiles)
    right, bottom = max(tile.right for tile in tiles), max(tile.bottom for tile in tiles)
    place = (left, top, right - left, bottom - top)
    image.write(pixels[top:bottom, left:right].tobytes(), viewport=place)


def texture_ref(texture: moderngl.Texture) -> imgui.ImTextureRef:
    return imgui.ImTextureRef(texture.glo)
