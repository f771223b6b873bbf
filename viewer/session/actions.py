"""Actions of keys and buttons that take more than one step of the session."""

from tracer.choices import MODELS
from viewer.base.files import Unusable
from viewer.base.orbit import Orbit
from viewer.lessons import lesson as lessons
from viewer.session.history import Place
from viewer.session.refinement import Strategy
from viewer.session.session import Session
from viewer.session.view_state import Request


def nudge(session: Session, dx: int, dy: int) -> None:
    """Move the picked pixel. The first time, pick the centre of the image."""
    if not session.world:
        return
    width, height = session.size
    x, y = session.pixel or (width // 2 - dx, height // 2 - dy)
    session.pick(x + dx, y + dy, series="nudge")


def choose_sample(session: Session, number: int) -> None:
    """Show the tree of another sample of the picked pixel. After the last one comes the first one again."""
    if not session.world:
        return
    count = session.world.scene.image.samples
    if count == 1:
        session.notice.say("a pixel of this scene has one sample, its centre; samples = N below [image] gives it N")
        return
    session.sample.chosen = number % count
    session.tree = None
    session.turn_back()
    session.history.note(sample=session.sample.chosen)
    session.update()


def step_sample(session: Session, by: int) -> None:
    """Show the tree of the next sample of the picked pixel, or the one before."""
    if session.world:
        choose_sample(session, (session.sample.number(session.world.scene) or 0) + by)


def step(session: Session, by: int) -> None:
    """Select the next ray in the order of the table, or the previous one."""
    if session.tree:
        row = (-1 if by > 0 else len(session.tree)) if session.selected is None else session.selected
        session.select(min(max(row + by, 0), len(session.tree) - 1))


def go(session: Session, by: int) -> None:
    """Go back (-1) or forward (1) in the history."""
    place = session.history.move(by)
    if place is None or not session.opening:
        session.notice.say(f"there is no place {'before' if by < 0 else 'after'} this one")
    elif place.is_in(session.opening):
        _return_to(session, place)
    else:
        session.loader.load(place.opening)


def _return_to(session: Session, place: Place) -> None:
    """Pick the pixel and select the ray of a place in the scene on show."""
    pixel = place.opening.state.pixel
    session.put(session.inside(*pixel) if pixel else None, place.opening.between)
    session.selection = place.opening.state.select
    session.sample.chosen = place.opening.state.sample or 0
    session.turn_back()
    session.update()


def toggle_model(session: Session) -> None:
    """Change from Whitted's model to Fresnel's, or back."""
    session.set_model(MODELS[1 - MODELS.index(session.model)])


def toggle_refinement(session: Session) -> None:
    """Give pixels more samples, or pause."""
    session.refinement.toggle()
    if session.refinement.is_running:
        session.requests.append(Request.SHOW_ERROR)


def set_strategy(session: Session, strategy: Strategy) -> None:
    """Distribute samples in another way. The curves of the other strategies stay for comparison."""
    changed, session.refinement.strategy = strategy != session.refinement.strategy, strategy
    if changed and session.refinement.is_running and session.world:
        session.render()


def look_through_camera(session: Session) -> None:
    """Look at the scene from its own camera."""
    if session.world:
        view = session.world.view()
        session.orbit = Orbit.of_camera(view, session.world.scene.camera.up, session.frame.inside(view.eye))


def open_lesson(session: Session, name: str) -> None:
    """Open one of the program's lessons."""
    try:
        lesson = lessons.read(name, session.languages)
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))
        return
    session.loader.open(lesson.scene, lesson)


def step_line(session: Session, by: int) -> None:
    """Go to the next line of the recursion, or the one before, and show it."""
    session.recursion.go(by)
    session.requests.append(Request.SHOW_RECURSION)


def toggle_granularity(session: Session) -> None:
    """Reveal the tree by level, or by ray."""
    session.reveal.toggle_granularity()
    session.notice.say(session.reveal.words)


def toggle_order(session: Session) -> None:
    """Reveal the tree breadth-first, or depth-first."""
    session.reveal.toggle_order()
    session.notice.say(session.reveal.words)


def change_speed(session: Session, by: int) -> None:
    """Play faster (1) or slower (-1)."""
    session.reveal.change_speed(by)
    session.notice.say(session.reveal.speed_words)


def toggle_loop(session: Session) -> None:
    """Play endlessly, or once."""
    session.reveal.toggle_loop()
    session.notice.say("the steps play endlessly" if session.reveal.loops else "the steps play once")
