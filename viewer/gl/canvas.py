"""The pictures in panels: the 3D view, the rendered image and its maps. Each is made again only if it has changed."""

import time
from collections import defaultdict
from typing import NamedTuple

import moderngl
import numpy as np
from imgui_bundle import imgui

from tracer.tree.raytree import RayTree
from viewer.base.cached import Cached, Changed
from viewer.base.colormap import colorize
from viewer.base.orbit import Orbit
from viewer.explain.interfaces import Interface
from viewer.explain.sections import Part
from viewer.figures.layout.tree_plan import TreePlan
from viewer.figures.marks import Mark
from viewer.figures.ray_lines import NO_LINES, RayLines, drawn_rows, ray_lines, relatives
from viewer.figures.steps import Step, of_kinds, whole
from viewer.figures.visible.interface import Name, hit_of, interface_names
from viewer.gl.interface import interface_lines
from viewer.gl.lines import NO_ROWS
from viewer.gl.magnified import NEAR, Place, magnify
from viewer.gl.picture_texture import PictureTexture
from viewer.gl.stage import ImagePlane, Stage
from viewer.gl.stage_lines import (
    StageLines,
    frustum_lines,
    glass_edges,
    glow_lines,
    image_plane,
    normal_lines,
    style_rays,
)
from viewer.session.image_renderer import Picture
from viewer.session.session import Session

REFRESH = 0.4  # least seconds between the states of an unfinished image that the 3D view shows
RARELY = 10.0  # the same, as a multiple of the duration of such a frame


class Seen(NamedTuple):
    """A texture, and the corners of its place on the screen."""

    texture: moderngl.Texture
    first: tuple[float, float]
    end: tuple[float, float]


class Canvas:
    """The pictures that all panels share, and where things were drawn last, to find what is under a click."""

    def __init__(self, ctx: moderngl.Context, session: Session) -> None:
        self.ctx = ctx
        self.session = session
        self.stage = Stage(ctx)
        self.image = PictureTexture(ctx)
        self.tree: RayTree | None = None  # whose rays are in the 3D view
        self.lines: RayLines = NO_LINES  # these rays
        self.names: list[Name] = []  # at the selected hit
        self.kept: set[int] | None = None  # rows of these rays that stay bright beside the selected one; None: all
        self.drawn = 0  # rows of the tree that the 3D view draws, of all kinds
        self.scene_marks: Cached[list[Mark]] = Cached()  # over the 3D view
        self._under_mouse = ""  # the view that has set `Session.hovered`
        self.stage_place: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)  # left, top, width, height
        self.image_place: tuple[float, float, float] = (0.0, 0.0, 1.0)  # left, top, size of a pixel
        self.nodes: dict[int, tuple[float, float]] = {}  # of the tree: its boxes, and the signs of its shadow rays
        self.tree_plan: Cached[TreePlan] = Cached()
        self.tree_plan_of_ray: Cached[TreePlan] = Cached()  # in which a selected ray is seen that is folded otherwise
        self.tree_marks: Cached[list[Mark]] = Cached()
        self.ray_changed = Changed()  # the ray whose numbers are shown
        self.interfaces: Cached[list[Interface]] = Cached()  # at both ends of that ray
        self.certainty: Cached[list[str]] = Cached()  # of that ray, in sentences
        self.ray_ends: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)  # left, top, right, bottom of the same
        self.explanation: Cached[list[Part]] = Cached()  # of that ray
        self.hit: Cached[list[Mark]] = Cached()  # the marks of the hit on show
        # The marks of the live pieces of a lesson, by their lines; left and top on the screen, and pixels per point.
        self.live: defaultdict[int, Cached[list[Mark]]] = defaultdict(Cached[list[Mark]])
        self.live_places: dict[int, tuple[float, float, float]] = {}
        # The heights of what is below these pieces.
        self.below: defaultdict[int, Cached[float]] = defaultdict(Cached[float])
        self.sweep_place = ((0.0, 0.0), 1.0)  # the left end of the way of a sweep's knob on the screen, and its length
        self._whole: Cached[Step] = Cached()
        self._map: Cached[moderngl.Texture | None] = Cached(_release)
        self._near: Cached[Seen | None] = Cached(lambda seen: _release(seen and seen.texture))
        self._view_changed = Changed()
        self._lines_changed = Changed()
        self._world_changed = Changed()
        self._edges_changed = Changed()
        self._plane: np.ndarray | None = None
        self._throttle = _Throttle()

    def hover(self, view: str, row: int | None) -> None:
        """The mouse is over this view, and there over this row of the tree, which is highlighted in all views."""
        self._under_mouse, self.session.hovered = view, row

    def leave(self, view: str) -> None:
        """The mouse is not over this view."""
        if self._under_mouse == view:
            self._under_mouse, self.session.hovered = "", None

    def step(self, tree: RayTree) -> Step:
        """The step of this tree that is on show: all of it, if it is not revealed step by step."""
        return self.session.step or self._whole.get(tree, lambda: whole(tree))

    def picture(self) -> moderngl.Texture | None:
        """The rendered image as far as it is; its first row is the image's top."""
        shown = self.session.image.picture
        return self.image.update(shown) if shown else None

    def seen(self, place: Place) -> Seen | None:
        """The content of the image panel: the image or a map; magnified, its pixels as squares. None as long as there
        is nothing to see.
        """
        shown = self.session.image.picture
        if shown is None or shown.is_blank:
            return None
        if place.scale < NEAR:
            texture = self._map.get(self._map_key(), self._map_texture) or self.image.update(shown)
            width, height = (place.scale * side for side in texture.size)
            return Seen(texture, (place.left, place.top), (place.left + width, place.top + height))
        key = (place, self._map_key(), shown, len(shown.tiles))
        return self._near.get(key, lambda: self._magnified(shown, place))

    def _magnified(self, shown: Picture, place: Place) -> Seen | None:
        pixels = self._map_pixels()
        found = magnify(shown.shown if pixels is None else pixels, place)
        if found is None:
            return None
        pixels, left, top = found
        height, width = pixels.shape[:2]
        return Seen(self.ctx.texture((width, height), 4, pixels), (left, top), (left + width, top + height))

    def _map_key(self) -> object:
        """All that the map depends on. It changes from round to round."""
        refinement = self.session.refinement
        run = refinement.current
        if not run or refinement.shows == "image":
            return None
        return (run, refinement.shows, len(run.points), run.picture and run.picture.finished)

    def _map_texture(self) -> moderngl.Texture | None:
        pixels = self._map_pixels()
        return None if pixels is None else self.ctx.texture(pixels.shape[1::-1], 4, pixels)

    def _map_pixels(self) -> np.ndarray | None:
        values = self.session.refinement.map
        return None if values is None else colorize(values, self.session.refinement.shows)

    def view3d(self, size: tuple[int, int], scale: float) -> moderngl.Texture:
        """The 3D view, `size` in pixels, `scale` pixels per logical pixel; bottom row first, as OpenGL has it."""
        session, theme = self.session, self.session.appearance.theme
        image = self.picture() if session.shown.camera else None
        lines, state = self._lines_key(), self._image_state()
        if self._view_changed((size, scale, lines, session.hovered, self._eye(), state)):
            self._set_world()
            if self._lines_changed(lines):
                self._set_lines()
            self.stage.set_glow(glow_lines(self.lines, session.hovered, theme))
            orbit = session.orbit.framed(size[0] / size[1])
            self._set_interface(orbit, size[1] / scale)
            plane = ImagePlane(self._plane, image, state) if image is not None and self._plane is not None else None
            self.stage.draw(orbit, theme, size, scale, plane)
            self._throttle.drawn = True
        return self.stage.target.texture

    def frame_took(self, seconds: float) -> None:
        """Called after each frame of the window."""
        self._throttle.frame_took(seconds)

    def _eye(self) -> tuple:
        orbit = self.session.orbit
        return (orbit.azimuth, orbit.elevation, orbit.distance, *orbit.target)

    def _image_state(self) -> object:
        session = self.session
        return self._throttle.state(session.image.picture, self.image.state) if session.shown.camera else None

    def _lines_key(self) -> tuple:
        """All that the lines of the 3D view depend on."""
        session, shown = self.session, self.session.shown
        switches = (frozenset(shown.kinds), shown.camera, shown.normals)
        return (switches, session.world, session.tree, session.step, session.selected, session.appearance.theme)

    def _set_world(self) -> None:
        session = self.session
        if not session.world:
            return
        if self._world_changed(session.world):
            self.stage.set_world(session.world, session.frame)
        if self._edges_changed((session.world, session.appearance.theme)):
            self.stage.set_edges(glass_edges(session.world, session.frame, session.appearance.theme))

    def _set_lines(self) -> None:
        session, theme = self.session, self.session.appearance.theme
        marks, rays = [NO_ROWS], (NO_ROWS, NO_ROWS)
        self.tree, self.lines, self.kept, self._plane = session.tree, NO_LINES, None, None
        if session.world and session.shown.camera:
            view = session.world.view()
            self._plane = image_plane(view, session.frame, np.zeros(3))
            marks.append(frustum_lines(view, session.frame, self._plane, theme))
        if session.tree:
            tree, selected = session.tree, session.selected
            rows = drawn_rows(tree, selected)
            self.drawn = len(rows)
            on_show = of_kinds(self.step(tree), session.shown.kinds).rows
            rows = [i for i in rows if i in on_show]
            self.kept = kept = relatives(tree, selected, rows) if selected is not None else None
            self.lines = ray_lines(tree, rows, session.frame, session.shown.kinds)
            rays = style_rays(tree, self.lines, kept, selected, theme)
            if session.shown.normals:
                marks.append(normal_lines(tree, rows, session.frame, kept, theme))
        self.stage.set_lines(StageLines(np.concatenate(marks), *rays))

    def _set_interface(self, orbit: Orbit, height: float) -> None:
        """Normal, angles, media and cone at the end of the selected ray. `height` of the picture in logical pixels."""
        session, self.names = self.session, []
        rows = NO_ROWS
        selected = session.selected_on_show
        if session.tree and selected is not None:
            step = of_kinds(self.step(session.tree), session.shown.kinds)
            hit = hit_of(session.tree, selected, session.frame, step)
            pixel = orbit.pixel_at(hit.foot, height) if hit else 0.0
            length = hit.length(pixel) if hit else 0.0
            if hit and length > 0.0:
                rows = interface_lines(hit, length, session.appearance.theme)
                self.names = interface_names(hit, length, hit.is_small(length, pixel))
        self.stage.set_interface(rows)

    def release(self) -> None:
        self.stage.release()
        self.image.release()
        self._map.release()
        self._near.release()


class _Throttle:
    """Limits how often the 3D view is drawn again only because an unfinished image has more tiles."""

    def __init__(self) -> None:
        self.drawn = False  # whether this frame drew the 3D view
        self.cost = 0.0  # seconds of the last frame that did
        self.since = 0.0  # when the shown state of the image was taken
        self.shown: object = None
        self.new_picture = Changed()

    def state(self, picture: Picture | None, newest: object) -> object:
        """The state of the image that the 3D view shows: the newest, or the one before if it is too early."""
        now = time.monotonic()
        if self.new_picture(picture):
            self.since = now  # its first tiles can wait as well
        if picture is None or picture.finished or now - self.since > max(REFRESH, RARELY * self.cost):
            self.shown, self.since = newest, now
        return self.shown

    def frame_took(self, seconds: float) -> None:
        if self.drawn:
            self.cost = seconds
        self.drawn = False


def _release(texture: moderngl.Texture | None) -> None:
    if texture:
        texture.release()


def texture_ref(texture: moderngl.Texture) -> imgui.ImTextureRef:
    """The texture as an imgui texture reference."""
    return imgui.ImTextureRef(texture.glo)
