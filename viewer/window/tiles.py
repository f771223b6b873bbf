"""The panels in their places, the borders between them, and which panel is in front."""

from collections.abc import Callable, Sequence

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.gl.canvas import Canvas
from viewer.panels import PANELS, draw as d
from viewer.panels.panel import Panel
from viewer.session.layout import GAP, Arrangement, Corner, Layout, Rectangle, tile
from viewer.session.session import Session
from viewer.session.view_state import Request
from viewer.window import frame

# All that follow show at once what is picked in the image, and then what is selected in the tree.
ORDER = (Corner.TOP_RIGHT, Corner.BOTTOM_LEFT, Corner.BOTTOM_RIGHT, Corner.TOP_LEFT)


class Tiles:
    """Draws the panels of a session."""

    def __init__(
        self, session: Session, canvas: Canvas, part: Callable[..., object], fulfil: Callable[[], object]
    ) -> None:
        """`part` draws a part of the window, and reports a failure. `fulfil` does what the session asks for, such as to
        show a panel.
        """
        self.session = session
        self.canvas = canvas
        self.part = part
        self.fulfil = fulfil
        self.places: dict[Corner, Rectangle] = {}  # when they were drawn last

    def draw(self, room: Rectangle) -> None:
        """The panel in front of each place, or the one that has all of the room."""
        session = self.session
        layout, sharing = session.layout, self._sharing()
        arrangement = self._arrangement
        alone = next((p for panels in sharing.values() for p in panels if p.name == layout.maximised), None)
        if alone:
            self.places, borders = {alone.place_in(session): room}, {}
        else:
            self.places, borders = tile(
                arrangement, layout.closed(session.appearance.is_lecture_size), set(sharing), room, GAP * d.unit()
            )
        layout.on_show = set(self.places)
        pointed = alone or self._under_mouse()
        is_in_menu = imgui.is_popup_open("", imgui.PopupFlags_.any_popup)
        if pointed and pointed.figure and not is_in_menu:
            layout.pointed = pointed.figure
        self.part("the borders", lambda: self._borders(arrangement, borders, room), closes=False)
        for act in (self._first, self._draw):
            for place in ORDER:
                if place in self.places and place in self._sharing():  # a request may have closed it
                    panels, front = ([alone], alone) if alone else self._front(place)
                    act(panels, front, self.places[place])
                    self.fulfil()

    def _sharing(self) -> dict[Corner, list[Panel]]:
        """The panels of each place."""
        found: dict[Corner, list[Panel]] = {}
        for panel in PANELS:
            if panel.exists(self.session):
                found.setdefault(panel.place_in(self.session), []).append(panel)
        return found

    def _first(self, _: Sequence[Panel], front: Panel, where: Rectangle) -> None:
        """Do what a panel does before any is drawn."""
        act = front.first
        if act:
            frame.draw_first(front, where, lambda: self.part(front.title, lambda: act(self.session, self.canvas)))

    def _draw(self, panels: Sequence[Panel], front: Panel, where: Rectangle) -> None:
        frame.draw(self.session, panels, front, where, lambda: self._panel(front), lambda wide: self._head(front, wide))

    def _head(self, panel: Panel, wide: float) -> None:
        """Draw the content beside the title."""
        draw = panel.head
        if draw:
            self.part(f"the title of {panel.title}", lambda: draw(self.session, wide))

    def _panel(self, panel: Panel) -> None:
        closed = self.session.guard.closed.get(panel.title)
        if closed:
            imgui.text_wrapped(closed)
        else:
            self.part(panel.title, lambda: panel.draw(self.session, self.canvas))

    def _borders(self, arrangement: Arrangement, borders: dict[int | None, Rectangle], room: Rectangle) -> None:
        """The borders between places, which can be dragged. A double click puts one back."""
        imgui.set_next_window_pos(room[:2])
        imgui.set_next_window_size(room[2:])
        flags = imgui.WindowFlags_
        imgui.push_style_color(imgui.Col_.window_bg, self.session.appearance.theme.ground)
        imgui.begin(
            "##room", None, flags.no_decoration | flags.no_move | flags.no_docking | flags.no_saved_settings
            | flags.no_bring_to_front_on_focus | flags.no_nav,
        )  # fmt: skip
        imgui.pop_style_color()
        internal.bring_window_to_display_back(internal.get_current_window())
        for which, (left, top, width, height) in borders.items():
            imgui.set_cursor_screen_pos((left, top))
            imgui.invisible_button(f"border {which}", (width, height))
            if imgui.is_item_hovered() or imgui.is_item_active():
                shapes = imgui.MouseCursor_
                imgui.set_mouse_cursor(shapes.resize_ew if which is None else shapes.resize_ns)
                ink = imgui.get_color_u32(self.session.appearance.theme.accent)
                imgui.get_window_draw_list().add_rect_filled((left, top), (left + width, top + height), ink)
            if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
                layout = Layout(taught=self.session.layout.taught)
                arrangement.reset_split(which, layout.current(self.session.appearance.is_lecture_size))
            elif imgui.is_item_active():
                mouse = imgui.get_mouse_pos()
                share = (mouse.x - room[0]) / room[2] if which is None else (mouse.y - room[1]) / room[3]
                arrangement.split(which, share)
        imgui.end()

    def _front(self, place: Corner) -> tuple[list[Panel], Panel]:
        """The panels of a place, and the one in front."""
        panels = self._sharing()[place]
        chosen = self._arrangement.front.get(place)
        return panels, next((panel for panel in panels if panel.name == chosen), panels[0])

    @property
    def _arrangement(self) -> Arrangement:
        return self.session.layout.current(self.session.appearance.is_lecture_size)

    def bring_to_front(self, panel: Panel) -> None:
        """Show a panel. The selected ray does not cover a panel that shows it, too."""
        place = panel.place_in(self.session)
        _, front = self._front(place)
        if panel.request is not Request.SHOW_RAY or not front.shows_ray:
            self._show(panel)

    def show_next(self) -> None:
        """Of the panels that share a place at the lower right, or beside a lesson at the lower left, show the one after
        that on show.
        """
        place = Corner.BOTTOM_LEFT if self.session.layout.taught else Corner.BOTTOM_RIGHT
        if place not in self._sharing():
            return
        panels, front = self._front(place)
        # The tree shares this place in lecture mode, except while it stands beside the panel in front.
        if self.session.layout.has_tree_beside(self.session.appearance.is_lecture_size):
            self._arrangement.front[Corner.BOTTOM_RIGHT] = "tree"
        else:
            self._show(panels[(panels.index(front) + 1) % len(panels)])

    def _show(self, panel: Panel) -> None:
        self.session.layout.bring_to_front(panel.name, self.session.appearance.is_lecture_size)

    def maximise(self) -> None:
        """Give the panel under the mouse all of the room, or give it back."""
        layout, panel = self.session.layout, self._under_mouse()
        if not layout.give_back() and panel:
            layout.maximise(panel.name)

    def _under_mouse(self) -> Panel | None:
        mouse = imgui.get_mouse_pos()
        for place, (left, top, width, height) in self.places.items():
            if left <= mouse.x < left + width and top <= mouse.y < top + height:
                return self._front(place)[1]
        return None
