"""The image as it renders: click or drag to pick a pixel, wheel to zoom, double click to fit, arrow keys to move by a
pixel. Enlarged, it shows the points of the picked pixel's samples: a click on one shows the rays of that sample.
"""

from imgui_bundle import imgui

from viewer.base.colormap import RANGES, gradient
from viewer.base.theme import SMALL
from viewer.gl.canvas import Canvas, texture_ref
from viewer.gl.magnified import Place
from viewer.panels import draw as d
from viewer.panels.panel import Panel
from viewer.panels.pixel.colors import draw_colors
from viewer.panels.pixel.dots import dot_at, draw_dots
from viewer.panels.pixel.sample_line import draw_line, has_line, line_height
from viewer.session.actions import choose_sample
from viewer.session.session import Session


def draw(session: Session, canvas: Canvas) -> None:
    """The picture, below a line with the chosen sample if pixels have several."""
    if not has_line(session):
        draw_picture(session, canvas)
        return
    corner, width = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
    imgui.set_cursor_screen_pos((corner.x, corner.y + line_height()))
    draw_picture(session, canvas)
    draw_line(session, corner, width)  # last: it shows what is picked in the picture


def draw_picture(session: Session, canvas: Canvas) -> None:
    corner = imgui.get_cursor_screen_pos()
    room = imgui.get_content_region_avail()
    if room.x < 8 or room.y < 8:
        return
    imgui.invisible_button(
        "picture", room, imgui.ButtonFlags_.mouse_button_left | imgui.ButtonFlags_.mouse_button_right
    )
    canvas_draw = imgui.get_window_draw_list()
    if not session.world:
        draw_waiting(session, canvas_draw, corner, room)
        return
    place = _place(session, corner, room)
    canvas.image_place = place
    dot = dot_at(session, place, imgui.get_mouse_pos()) if imgui.is_item_hovered() else None
    _handle_mouse(session, place, dot)
    canvas_draw.push_clip_rect(corner, (corner.x + room.x, corner.y + room.y), True)
    panel = (corner.x, corner.y, corner.x + room.x, corner.y + room.y)
    seen = canvas.seen(Place(*place, panel))
    if seen is not None:
        canvas_draw.add_image(texture_ref(seen.texture), seen.first, seen.end)
        if session.pixel:
            _mark_pixel(session, canvas_draw, place)
            draw_dots(session, canvas_draw, place, dot)
    else:
        draw_waiting(session, canvas_draw, corner, room)
    canvas_draw.pop_clip_rect()
    _note(session, canvas_draw, corner, room)
    _progress(session, canvas_draw, corner, room)


def _place(session: Session, corner: imgui.ImVec2, room: imgui.ImVec2) -> tuple[float, float, float]:
    """Left and top of the image on the screen, and the size of one of its pixels."""
    width, height = session.size
    look = session.image_view
    scale = min(room.x / width, room.y / height) * look.zoom
    left = corner.x + 0.5 * room.x - look.center[0] * width * scale
    top = corner.y + 0.5 * room.y - look.center[1] * height * scale
    return left, top, scale


def _handle_mouse(session: Session, place: tuple[float, float, float], dot: int | None) -> None:
    """`dot` is the sample whose dot is under the mouse."""
    left, top, scale = place
    io = imgui.get_io()
    mouse = imgui.get_mouse_pos()
    look = session.image_view
    if dot is not None:
        imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
        if imgui.is_mouse_clicked(imgui.MouseButton_.left):
            choose_sample(session, dot)
    elif imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        look.fit()
    elif imgui.is_item_active() and imgui.is_mouse_down(imgui.MouseButton_.left) and io.mouse_clicked_count[0] != 2:
        drag = ("drag", io.mouse_clicked_time[0])
        session.pick(int((mouse.x - left) // scale), int((mouse.y - top) // scale), drag)
    width, height = session.size
    if imgui.is_item_active() and imgui.is_mouse_dragging(imgui.MouseButton_.right):
        look.move(-io.mouse_delta.x / (scale * width), -io.mouse_delta.y / (scale * height))
    if imgui.is_item_hovered() and io.mouse_wheel != 0.0:
        at = ((mouse.x - left) / (scale * width), (mouse.y - top) / (scale * height))
        look.zoom_about(at, io.mouse_wheel)


def _mark_pixel(session: Session, draw: imgui.ImDrawList, place: tuple[float, float, float]) -> None:
    """A frame around the picked pixel, or the place between pixels, with four arms that leave it free."""
    left, top, scale = place
    assert session.pixel
    pixel = session.between or session.pixel
    x0, y0 = left + pixel[0] * scale, top + pixel[1] * scale
    x, y = x0 + 0.5 * scale, y0 + 0.5 * scale
    unit = d.unit()
    inner = max(5.0 * unit, 0.5 * scale + 2.0 * unit)
    outer = inner + 11.0 * unit
    dark, bright = d.u32((0, 0, 0, 0.85)), d.u32((1, 1, 1, 1))
    for ink, width in ((dark, 4.0 * unit), (bright, 1.8 * unit)):
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            draw.add_line((x + inner * dx, y + inner * dy), (x + outer * dx, y + outer * dy), ink, width)
        half = inner - 1.5 * unit
        draw.add_rect((x - half, y - half), (x + half, y + half), ink, 2.0 * unit, 0.6 * width)


def _head(session: Session, room: float) -> None:
    """The picked pixel's coordinates, which can be typed, and its colour; or the scale of the map on show."""
    if not session.world:
        imgui.text("Image")
        return
    unit, theme = d.unit(), session.appearance.theme
    x, y = session.pixel or (-1, -1)
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (4.0 * unit, 1.0 * unit))
    imgui.align_text_to_frame_padding()
    imgui.text_colored(theme.muted, "pixel")
    for label, value in (("x", x), ("y", y)):
        imgui.same_line(0.0, 6.0 * unit)
        imgui.set_next_item_width(d.text_size("0000", imgui.get_font_size())[0] + 8.0 * unit)
        written = "" if value < 0 else str(value)
        flags = imgui.InputTextFlags_
        changed, text = imgui.input_text(
            f"##{label}", written, flags.chars_decimal | flags.enter_returns_true | flags.auto_select_all
        )
        if changed and text.isdigit():
            session.pick(*((int(text), max(y, 0)) if label == "x" else (max(x, 0), int(text))))
    imgui.same_line(0.0, 10.0 * unit)
    left = room - imgui.get_cursor_pos_x()
    if session.refinement.shows_map:
        _scale(session, left)
    elif session.tree:
        draw_colors(session, session.tree, left)
    else:
        imgui.text_colored(theme.muted, "click the image")
    imgui.pop_style_var()


def _scale(session: Session, room: float) -> None:
    """The scale of the map's colours."""
    unit, size = d.unit(), imgui.get_font_size()
    low, high = (f"{value:g}" for value in RANGES[session.refinement.shows])
    word = session.refinement.shows
    gap = 6.0 * unit
    if d.text_size(word + low + high, size)[0] + 100 * unit <= room:
        imgui.text_colored(session.appearance.theme.muted, word)
        imgui.same_line(0.0, gap)
    imgui.text(low)
    imgui.same_line(0.0, gap)
    at, bar = imgui.get_cursor_screen_pos(), 60 * unit
    pad, colors = imgui.get_window_draw_list(), gradient(48)
    for k, color in enumerate(colors):
        a, b = at.x + k * bar / len(colors), at.x + (k + 1) * bar / len(colors)
        pad.add_rect_filled((a, at.y + 0.1 * size), (b + 0.5, at.y + size), d.u32(color))
    imgui.dummy((bar, size))
    imgui.same_line(0.0, gap)
    imgui.text(high)


def _note(session: Session, draw: imgui.ImDrawList, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    """A note at the bottom: what of the samples is shown so far, and how many trees the limit of rays ended."""
    shown = session.image.picture
    notes = []
    if shown and shown.is_preview:
        notes.append(f"pixel centres; the mean of {shown.samples} samples follows")
    if shown and shown.limited:
        trees = "samples" if shown.is_endless or shown.samples > 1 else "pixels"
        notes.append(f"{shown.limited:,} {trees} stopped at the limit of {shown.max_nodes:,} rays")
    if not notes:
        return
    size, content = SMALL * imgui.get_font_size(), "; ".join(notes)
    content = d.shortened(content, size, room.x - 12 * d.unit())
    place = (corner.x + 6 * d.unit(), corner.y + room.y - size - 8 * d.unit())
    d.text(draw, place, session.appearance.theme.text, content, size, session.appearance.theme.panel)


def _progress(session: Session, draw: imgui.ImDrawList, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    """A thin bar while the image is not finished."""
    shown = session.image.picture
    if shown is None or shown.finished or shown.is_endless:
        return
    bottom = corner.y + room.y
    height = 4.0 * d.unit()
    draw.add_rect_filled(
        (corner.x, bottom - height), (corner.x + room.x, bottom), d.u32(session.appearance.theme.raised)
    )
    end = corner.x + room.x * shown.share
    draw.add_rect_filled((corner.x, bottom - height), (end, bottom), d.u32(session.appearance.theme.accent))


def draw_waiting(session: Session, draw: imgui.ImDrawList, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    """The status, while there is no image yet."""
    lines = waiting_lines(session)
    size = imgui.get_font_size()
    top = corner.y + 0.5 * room.y - 0.7 * size * len(lines)
    for k, content in enumerate(lines):
        scaled = size if k == 0 else SMALL * size
        content = d.shortened(content, scaled, room.x)
        width, _ = d.text_size(content, scaled)
        color = session.appearance.theme.text if k == 0 else session.appearance.theme.muted
        d.text(draw, (corner.x + 0.5 * (room.x - width), top + 1.4 * size * k), color, content, scaled)


def waiting_lines(session: Session) -> list[str]:
    if session.faults and not session.world:
        return [
            "This scene cannot be shown.",
            "The faults are listed in the other window. Correct the file and save it: it is read again.",
        ]
    if not session.warmup.ready and session.warmup.compiles:
        seconds = session.warmup.seconds
        return [
            f"Compiling the kernels: {seconds:.0f} s of about 20",
            "This happens only at the first start on this machine.",
        ]
    return ["Rendering ..." if session.world else "Loading ..."]


PANEL = Panel("Image", draw, fills=True, head=_head, is_named=False)
