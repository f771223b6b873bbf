"""The state of the view on show, and a session that takes it over."""

from dataclasses import replace
from typing import Protocol, TypeVar

from tracer.kernel.world import World
from viewer.base.orbit import Frame, Orbit, orbit_beside
from viewer.base.theme import DARK, LIGHT
from viewer.reopen.view_state import GRANULARITIES, KINDS, LEFT, ORDERS, SWITCHES, TYPE_SIZES, ViewState
from viewer.session.layout import Layout, usual_borders
from viewer.session.stepping.reveal import Reveal
from viewer.session.stepping.sample import SampleChoice
from viewer.session.view_state import Appearance, Notice, PanZoom, Request, Visibility

T = TypeVar("T")


class Viewed(Protocol):
    """The parts of a session that a view's state is about."""

    world: World | None
    frame: Frame
    orbit: Orbit
    shown: Visibility
    layout: Layout
    image_view: PanZoom
    tree_view: PanZoom
    appearance: Appearance
    requests: list[Request]
    notice: Notice
    pixel: tuple[int, int] | None
    sample: SampleChoice
    depth: int
    model: str
    selection: str | None
    turn: float | None
    inset: str
    reveal: Reveal

    def show_faults(self, faults: list[str]) -> None: ...
    @property
    def at(self) -> tuple[int, int] | None: ...
    @property
    def swept(self) -> float | None: ...
    @property
    def up(self) -> str: ...
    @property
    def selected(self) -> int | None: ...


def state_of(viewed: Viewed) -> ViewState:
    """The state of the view on show. What is as in a new window is None, except for panels, theme and size of type."""
    shown, look = viewed.shown, viewed.appearance
    hidden = tuple(name for name in SWITCHES if not getattr(shown, name))
    return ViewState(
        at=viewed.at,
        swept=viewed.swept,
        pixel=viewed.pixel,
        sample=(viewed.world and viewed.sample.number(viewed.world.scene)) or None,
        depth=viewed.depth,
        model=viewed.model,
        up=viewed.up,
        select=viewed.selection if viewed.selected is not None else None,
        step=_unless_usual(viewed.reveal.granularity, GRANULARITIES[0]),
        order=_unless_usual(viewed.reveal.order, ORDERS[0]),
        page=viewed.reveal.position,
        turn=viewed.turn,
        camera=viewed.orbit.view(viewed.frame),
        filter=shown.filter,
        hide=hidden or None,
        theme=look.theme.name,
        type_size=type_size_of(look),
        panels=None if viewed.layout.beside() else viewed.layout.shown(look.is_lecture_size),
        beside=viewed.layout.beside() or None,
        borders=_unless_usual(
            viewed.layout.borders(look.is_lecture_size), usual_borders(viewed.layout, look.is_lecture_size)
        ),
        inset=_unless_usual(viewed.inset, LEFT),
        image_zoom=_pan_zoom(viewed.image_view),
        tree_zoom=_pan_zoom(viewed.tree_view),
    )


def complete(state: ViewState) -> ViewState:
    """The state with the values of a new window for the steps, the kinds of rays, the parts shown and the inset, if it
    has none: a window that takes it over may show others.
    """
    return replace(
        state,
        step=state.step or GRANULARITIES[0],
        order=state.order or ORDERS[0],
        filter=KINDS if state.filter is None else state.filter,
        hide=() if state.hide is None else state.hide,
        inset=state.inset or LEFT,
    )


def restore(viewed: Viewed, state: ViewState, note: str = "") -> None:
    """Take over how a scene is looked at, and say a note on it. The scene must be on show; it is opened with pixel,
    depth and model.
    """
    if note:
        viewed.notice.say(note)
    restore_appearance(viewed.appearance, state)
    restore_layout(viewed.layout, viewed.appearance.is_lecture_size, state)
    if state.filter is not None:
        viewed.shown.kinds = set(state.filter)
    for name in SWITCHES if state.hide is not None else ():
        setattr(viewed.shown, name, name not in (state.hide or ()))
    for look, zoom in ((viewed.image_view, state.image_zoom), (viewed.tree_view, state.tree_zoom)):
        if zoom:
            look.zoom, look.center = zoom[0], (zoom[1], zoom[2])
    viewed.sample.chosen = state.sample or 0
    viewed.turn = state.turn
    viewed.inset = state.inset or viewed.inset
    viewed.reveal.ask(state.step, state.order, state.page)
    restore_camera(viewed, state)
    if state.panels or state.beside:
        viewed.requests[:] = [request for request in viewed.requests if request is not Request.SHOW_LESSON]
    elif state.select:
        viewed.requests.append(Request.SHOW_RAY)


def restore_appearance(look: Appearance, state: ViewState) -> None:
    """Take over theme and size of type, which no scene is needed for."""
    if state.theme:
        look.theme = DARK if state.theme == DARK.name else LIGHT
    if state.type_size and state.type_size != type_size_of(look):
        look.toggle_lecture_size()


def restore_layout(layout: Layout, is_lecture: bool, state: ViewState) -> None:
    """Take over the panels on show, and the borders between them."""
    if state.beside:
        layout.teach(state.beside)
    elif state.panels:
        layout.show(state.panels, is_lecture)
    for which, share in zip((None, 0, 1), state.borders or (), strict=False):
        layout.current(is_lecture).split(which, share)


def restore_camera(viewed: Viewed, state: ViewState) -> None:
    """Take over the 3D view: azimuth, elevation, distance, and if given the target. One that cannot be is a fault."""
    if state.camera and viewed.world:
        azimuth, elevation, distance, *target = state.camera
        try:
            viewed.orbit = orbit_beside(viewed.world, viewed.frame, azimuth, elevation, distance, target)
        except ValueError as error:
            viewed.show_faults([str(error)])


def type_size_of(look: Appearance) -> str:
    return TYPE_SIZES[look.is_lecture_size]


def _unless_usual(value: T, usual: T) -> T | None:
    return None if value == usual else value


def _pan_zoom(look: PanZoom) -> tuple[float, float, float] | None:
    is_fit = look.zoom == 1.0 and look.center == look.home
    return None if is_fit else (float(look.zoom), float(look.center[0]), float(look.center[1]))
