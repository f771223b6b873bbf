"""The bar at the bottom: depth, model, the kinds of rays (a legend of switches), and the status."""

from imgui_bundle import imgui

from tracer.choices import MODELS
from viewer.base.theme import STYLES, blend, faded
from viewer.figures.legend import ray_sample
from viewer.figures.writers.imgui import draw_marks
from viewer.panels import draw as d
from viewer.panels.image import waiting_lines
from viewer.session.session import Session

NAME = "##bar"
SAMPLE_LENGTH = 28.0  # logical pixels
SAMPLE = 44  # logical pixels of a legend entry beside its name
GAP = 6  # between two entries


def height() -> float:
    return round(2.15 * imgui.get_font_size())


def draw(session: Session, left: float, top: float, width: float) -> None:
    flags = imgui.WindowFlags_
    imgui.set_next_window_pos((left, top))
    imgui.set_next_window_size((width, height()))
    imgui.push_style_var(imgui.StyleVar_.window_padding, (8 * d.unit(), 5 * d.unit()))
    imgui.push_style_color(imgui.Col_.window_bg, session.appearance.theme.ground)
    imgui.begin(
        NAME, None, flags.no_decoration | flags.no_move | flags.no_docking | flags.no_saved_settings | flags.no_nav
    )
    imgui.pop_style_color()
    imgui.pop_style_var()
    is_lecture = session.appearance.is_lecture_size  # then there is room for what a student needs
    _depth(session, not is_lecture)
    if _has_glass(session) and not is_lecture:
        _gap()
        _model(session)
    content = "" if is_lecture else _status_text(session)
    status_at = width - d.text_size(content, imgui.get_font_size())[0] - 12 * d.unit()
    _gap()
    _legend(session, status_at)
    if content:
        _status(session, content, status_at)
    imgui.end()


def _gap() -> None:
    imgui.same_line(0.0, 18 * d.unit())


def _depth(session: Session, has_signs: bool) -> None:
    """The depths 0 to 3, with `has_signs` the next and the one before, and a larger depth."""
    imgui.align_text_to_frame_padding()
    imgui.text("Depth")
    for depth in range(4):
        imgui.same_line(0.0, (8 if depth == 0 else 3) * d.unit())
        if d.toggle(session.appearance.theme, str(depth), session.depth == depth):
            session.set_depth(depth)
        d.hint(f"rays that were reflected or refracted at most {depth} times (key {depth})")
    for sign, by, does in (("−", -1, "decrease"), ("+", 1, "increase")) if has_signs else ():
        imgui.same_line(0.0, 3 * d.unit())
        if imgui.button(sign):
            session.set_depth(session.depth + by)
        d.hint(f"{does} the depth by one (key {sign.replace('−', '-')})")
    if session.depth > 3:
        imgui.same_line(0.0, 6 * d.unit())
        d.toggle(session.appearance.theme, str(session.depth), True)


def _model(session: Session) -> None:
    hints = (
        "Whitted 1980: every surface reflects and transmits fixed fractions",
        "Fresnel: the fractions depend on the angle, as in nature",
    )
    for k, (model, hint) in enumerate(zip(MODELS, hints, strict=True)):
        if k:
            imgui.same_line(0.0, 3 * d.unit())
        if d.toggle(session.appearance.theme, model.capitalize(), session.model == model):
            session.set_model(model)
        d.hint(hint)


def _legend(session: Session, right: float) -> None:
    """Each kind of ray as it is drawn, with its name. A click shows or hides it. The legend ends left of `right`."""
    unit = d.unit()
    theme = session.appearance.theme
    labels = _labels(session, right - imgui.get_cursor_pos_x())
    for k, (kind, style) in enumerate(STYLES.items()):
        if k:
            imgui.same_line(0.0, GAP * unit)
        on = kind in session.shown.kinds
        label = labels[kind]
        width, _ = d.text_size(label, imgui.get_font_size())
        at = imgui.get_cursor_screen_pos()
        size = (width + SAMPLE * unit, imgui.get_frame_height())
        if imgui.invisible_button(f"legend {kind}", size):
            session.shown.toggle_kind(kind)
        hovered = imgui.is_item_hovered()
        d.hint(f"{style.label}: {_meaning(session, kind)} (click to {'hide' if on else 'show'})")
        pad = imgui.get_window_draw_list()
        if hovered:
            pad.add_rect_filled(at, (at.x + size[0], at.y + size[1]), d.u32(theme.hover), 4 * unit)
        opacity = 1.0 if on else 0.32
        middle = at.y + 0.5 * size[1]
        sample = ray_sample(kind, (0.0, 0.0), SAMPLE_LENGTH, blend(theme.ray(kind), opacity, theme.ground))
        draw_marks(pad, [sample], (at.x + 5 * unit, middle), unit)
        text_at = (at.x + 38 * unit, middle - 0.5 * imgui.get_font_size())
        d.text(pad, text_at, faded(theme.text, opacity), label, imgui.get_font_size())
        if not on:
            pad.add_line((at.x + 37 * unit, middle), (at.x + 39 * unit + width, middle), d.u32(theme.muted), 1.2 * unit)


def _labels(session: Session, room: float) -> dict[str, str]:
    """The names in the legend: the longest that fit into `room`, at last the letters."""
    full = {kind: style.label for kind, style in STYLES.items()}
    short = full | {"tir": "total internal"}
    if _has_glass(session):
        # A frequent question: why does the shadow of a glass ball have no bright spot?
        through = "stopped by glass" if _glass_blocks(session) else "unbent in glass"
        full["shadow"] += f", {through}"
        short["shadow"] += f", {through}"
    shorter = {"camera": "camera", "reflection": "reflected", "refraction": "refracted", "tir": "total internal",
               "shadow": "to light"}  # fmt: skip
    letters = {kind: style.letter for kind, style in STYLES.items()}
    for labels in (full, short, shorter):
        widths = [d.text_size(label, imgui.get_font_size())[0] for label in labels.values()]
        if sum(widths) + len(widths) * (SAMPLE + GAP) * d.unit() <= room:
            return labels
    return letters


def _has_glass(session: Session) -> bool:
    return bool(session.world) and session.world.has_glass


def _glass_blocks(session: Session) -> bool:
    return bool(session.world) and session.world.scene.tracing.shadows == "block"


def _meaning(session: Session, kind: str) -> str:
    if kind == "shadow":
        glass = "blocks it" if _glass_blocks(session) else "dims it"
        return f"tests whether the light is visible. Glass {glass}, without bending the ray: a simplification"
    return {
        "camera": "from the eye through the pixel",
        "reflection": "reflected as by a mirror",
        "refraction": "through the surface, bent by Snell's law",
        "tir": "no light is refracted, all is reflected",
    }[kind]


def _status(session: Session, content: str, place: float) -> None:
    """The status, at the right end."""
    imgui.same_line()
    if imgui.get_cursor_pos_x() < place:
        imgui.set_cursor_pos_x(place)
        imgui.align_text_to_frame_padding()
        imgui.text_colored(session.appearance.theme.muted, content)


def _status_text(session: Session) -> str:
    picture = session.image.picture
    if not session.world or not picture:
        return waiting_lines(session)[0]
    count = len(session.tree) if session.tree else 0
    rays = f"{count} ray{'s' if count > 1 else ''}" if count else "no pixel picked"
    if picture.is_endless:
        return f"{rays}  ·  image {'refined' if picture.finished else 'being refined'}"
    if picture.finished:
        return f"{rays}  ·  image in {picture.seconds:.2f} s"
    return f"{rays}  ·  image {100 * picture.share:.0f} %"
