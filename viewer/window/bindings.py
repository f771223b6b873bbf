"""The key bindings: one table for what keys do and for the help that explains them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from imgui_bundle import imgui

from viewer.panels import PANELS
from viewer.session.actions import (
    change_speed,
    go,
    look_through_camera,
    nudge,
    step,
    step_line,
    step_sample,
    toggle_granularity,
    toggle_loop,
    toggle_model,
    toggle_order,
    toggle_refinement,
)
from viewer.session.saving import copy_command, copy_step, export_figure
from viewer.session.session import Session
from viewer.session.view_state import Pointer, Request

Act = Callable[[Session], object]
K = imgui.Key
SHIFT = (K.left_shift, K.right_shift)
LINES = 3  # by which a key scrolls
PANEL_KEYS = (K.f2, K.f3, K.f4, K.f6, K.f7, K.f8, K.f9, K.f10)  # F5 is a key of remotes, F11 is full screen


@dataclass(frozen=True)
class Binding:
    """A row of the help, and what its keys do."""

    label: str
    meaning: str
    typed: Mapping[str, Act] = field(default_factory=dict)  # by character
    pressed: Mapping[imgui.Key, Act] = field(default_factory=dict)
    repeated: Mapping[imgui.Key, Act] = field(default_factory=dict)  # again and again while the key is held
    ctrl: Mapping[imgui.Key, Act] = field(default_factory=dict)  # together with Ctrl (on a Mac: Cmd)
    alt: Mapping[imgui.Key, Act] = field(default_factory=dict)  # together with Alt


def _has_shift() -> bool:
    return imgui.get_io().key_shift or just_released(SHIFT)


def _nudge(dx: int, dy: int) -> Act:
    def act(session: Session) -> None:
        pixels = 10 if _has_shift() else 1
        nudge(session, pixels * dx, pixels * dy)

    return act


def _toggle(name: str) -> Act:
    return lambda session: setattr(session.shown, name, not getattr(session.shown, name))


def _sample(session: Session) -> None:
    step_sample(session, -1 if _has_shift() else 1)


def _deeper(by: int) -> Act:
    return lambda session: session.set_depth(session.depth + by)


def _copy(session: Session) -> None:
    if _has_shift():
        copy_command(session)
    else:
        export_figure(session, copied=True)


def _copy_view(session: Session) -> None:
    if _has_shift():
        copy_step(session)
    else:
        session.requests.append(Request.COPY_VIEW)


def _escape(session: Session) -> None:
    """Close what is open; if nothing is, show the whole tree, then all panels, then unselect the ray."""
    if session.shows_help:
        session.shows_help = False
    elif session.faults:
        session.show_faults([])
    elif session.notes:
        session.notes = []
    elif not session.reveal.leave() and not session.layout.give_back():
        session.select(None)


def _blank(session: Session) -> None:
    session.is_blank = True


def _maximise(name: str) -> Act:
    return lambda session: session.layout.maximise(name)


def _point(session: Session) -> None:
    session.pointer = session.pointer.next()


def _scroll(by: int) -> Act:
    def act(session: Session) -> None:
        session.scroll += by

    return act


def _page(by: int) -> Act:
    """Go on in the lesson; without one, in the steps of the tree."""

    def act(session: Session) -> None:
        if _has_shift():
            step_line(session, by)
        elif session.player.go(by):
            _rest_mouse(session)
        else:
            session.reveal.go(by)

    return act


def _rest_mouse(session: Session) -> None:
    """A mouse that rests lights no ray of the next moment: it counts again when it moves, or at a click."""
    io = imgui.get_io()
    if session.pointer is Pointer.NONE and not any(io.mouse_down):
        io.add_mouse_pos_event(-imgui.FLT_MAX, -imgui.FLT_MAX)


def _home(session: Session) -> None:
    """Show the lesson's step again; without a lesson, the first step of the tree."""
    if not session.player.come_back():
        session.reveal.first()


def _speed(by: int) -> Act:
    return lambda session: change_speed(session, by)


def _help(session: Session) -> None:
    session.shows_help = not session.shows_help


BINDINGS = (
    Binding("click, drag", "on the image: show the rays of a pixel"),
    Binding(
        "arrow keys", "move the picked pixel (with Shift by 10)",
        repeated={
            K.left_arrow: _nudge(-1, 0), K.right_arrow: _nudge(1, 0),
            K.up_arrow: _nudge(0, -1), K.down_arrow: _nudge(0, 1),
        },
    ),
    Binding("wheel, right-drag", "on the image: zoom, move"),
    Binding(
        "S, Shift+S, click", "of a pixel with several samples: the next one, the one before, the one at a dot",
        {"s": _sample},
    ),
    Binding(
        "0 1 2 3 ... 9", "recursion depth",
        typed={str(depth): lambda session, depth=depth: session.set_depth(depth) for depth in range(10)},
    ),
    Binding("+  -", "increase, decrease the depth by one", typed={"+": _deeper(1), "=": _deeper(1), "-": _deeper(-1)}),
    Binding("click", "on a ray, in 3D, in the tree or in its hit: select it"),
    Binding("drag", "the disc in the picture of a hit: turn the ray (double click: back)"),
    Binding(
        "Alt+Down, Alt+Up", "select the next ray, the one before",
        alt={K.down_arrow: lambda session: step(session, 1), K.up_arrow: lambda session: step(session, -1)},
    ),
    Binding(
        "Page Down, Page Up", "the lesson: next moment, the one before (a scene without a lesson: steps of the tree)",
        pressed={K.page_down: _page(1), K.page_up: _page(-1)},
    ),
    Binding(
        "Ctrl+Page Down, Up", "reveal the tree: next step, the one before",
        ctrl={K.page_down: lambda s: s.reveal.go(1), K.page_up: lambda s: s.reveal.go(-1)},
    ),
    Binding("Shift+Page Down, Up", "the recursion: next line of its code, the one before"),
    Binding(
        "Home", "back to the lesson's step, after looking elsewhere (without a lesson: first step of the tree)",
        pressed={K.home: _home},
    ),
    Binding(
        "Ctrl+Home, End", "the tree: first step, last step",
        pressed={K.end: lambda s: s.reveal.last()},
        ctrl={K.home: lambda s: s.reveal.first(), K.end: lambda s: s.reveal.last()},
    ),
    Binding(
        "F5 or Space", "play the steps, pause", pressed=dict.fromkeys((K.f5, K.space), lambda s: s.reveal.toggle_play())
    ),
    Binding("<  >  E", "play slower, faster; endlessly", {"<": _speed(-1), ">": _speed(1), "e": toggle_loop}),
    Binding(
        "G  O", "steps: levels or rays; breadth-first as the kernel, or depth-first as the recursion",
        {"g": toggle_granularity, "o": toggle_order},
    ),
    Binding("J  K", "scroll the text or the numbers: down, up", {"j": _scroll(LINES), "k": _scroll(-LINES)}),
    Binding(
        "P", "next of the panels that share a place: ray, hit, lesson, error, recursion; in lecture mode also the tree",
        {"p": lambda session: session.requests.append(Request.NEXT_PANEL)},
    ),
    Binding(
        "Alt+Left, Alt+Right", "back to the pixel or scene before, forward again",
        alt={K.left_arrow: lambda session: go(session, -1), K.right_arrow: lambda session: go(session, 1)},
    ),
    Binding("drag, wheel", "in the scene: turn (with Shift or the right button: move), zoom; on the tree: move, zoom"),
    Binding("F", "fit scene, image and tree into their panels (double click: only that one)", {"f": Session.home}),
    Binding("V", "look through the scene's camera", {"v": look_through_camera}),
    Binding(
        "C  L  N  A", "camera, lights, normals, names: show or hide",
        {"c": _toggle("camera"), "l": _toggle("lights"), "n": _toggle("normals"), "a": _toggle("labels")},
    ),
    Binding(
        "Z, F2-F4, F6-F10", "all of the room: for the panel under the mouse, for scene, image, tree, ray, ...",
        {"z": lambda session: session.requests.append(Request.MAXIMISE)},
        {key: _maximise(panel.name) for key, panel in zip(PANEL_KEYS, PANELS, strict=False)},
    ),
    Binding("X", "pointer, spotlight", {"x": _point}),
    Binding("M", "Whitted's model or Fresnel's", {"m": toggle_model}),
    Binding("R", "refine the image, pause", {"r": toggle_refinement}),
    Binding("T", "light or dark theme", {"t": lambda s: s.appearance.toggle_theme()}),
    Binding(
        "Tab", "lecture mode: large type, two panels", pressed={K.tab: lambda s: s.appearance.toggle_lecture_size()}
    ),
    Binding(
        "F11", "full screen, and back (Esc does not leave it)",
        pressed={K.f11: lambda session: session.requests.append(Request.FULL_SCREEN)},
    ),
    Binding(
        "W", "the speaker's window: notes, next step, clock; again: close it",
        {"w": lambda session: session.requests.append(Request.SPEAKER)},
    ),
    Binding("B or .", "black screen; any key or click brings the window back", {"b": _blank, ".": _blank}),
    Binding(
        "Esc", "close a message or the help; leave the steps; show all panels; unselect the ray",
        pressed={K.escape: _escape},
    ),
    Binding(
        "Ctrl+S", "export the figure of the panel under the mouse (the menu Figure selects another)",
        ctrl={K.s: export_figure},
    ),
    Binding(
        "Ctrl+C", "copy that figure: a picture to paste onto a slide; with Shift its command line", ctrl={K.c: _copy}
    ),
    Binding(
        "Ctrl+L", "copy the command line that opens this view again (L: location); with Shift as a step of a lesson",
        ctrl={K.l: _copy_view},
    ),
    Binding(
        "Ctrl+O, R, Q", "open a scene or a lesson; reload it (automatic when it is saved); quit",
        ctrl={
            K.r: lambda session: session.loader.reload(),
            K.o: lambda session: session.requests.append(Request.OPEN_DIALOG),
            K.q: lambda session: session.requests.append(Request.QUIT),
        },
    ),
    Binding("H or ?", "this help", {"h": _help, "?": _help}),
)  # fmt: skip

HELP = [(binding.label, binding.meaning) for binding in BINDINGS]
TYPED = {character: act for binding in BINDINGS for character, act in binding.typed.items()}


def just_released(keys: tuple[imgui.Key, ...]) -> bool:
    """Whether a modifier came up in this frame: typed fast, that may be the frame in which the letter goes down."""
    return any(imgui.is_key_released(key) for key in keys)
