"""Makes the files of an export: a pixel's ray tree as figures and as data."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

import tracer
from tracer.formulas.sampler import sample_number
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.files import Unusable, write_atomically
from viewer.base.options import shell_line, words
from viewer.base.orbit import STEEPEST, Frame, Orbit, ViewAngles, initial_orbit, orbit_beside
from viewer.base.theme import THEMES
from viewer.explain.turned import turned
from viewer.figures.catalogue import BREADTH, FIGURES, FORMATS
from viewer.figures.export_options import ExportOptions
from viewer.figures.figure import both, tree
from viewer.figures.labels import hit_row
from viewer.figures.layout.tree_plan import fitting_size
from viewer.figures.lights import many_lights
from viewer.figures.marks import Figure, Text
from viewer.figures.pages import pages, with_details, with_upright
from viewer.figures.ray_lines import MOST_IN_FIGURE
from viewer.figures.steps import Step, by_color, by_depth, by_level, by_ray, of_kinds
from viewer.figures.subject import FigureStyle, Subject
from viewer.figures.targets import Target, check_pages, grouped, mark_of, stem_of
from viewer.figures.writers.png import PIXELS
from viewer.reopen.embedded import Embedded, pack
from viewer.reopen.places import CARRYING

FARTHER = 1.8  # largest factor by which the view moves back to show the scene's camera


@dataclass(frozen=True)
class Made:
    """Files with their content, and notes for the user."""

    files: list[tuple[Path, bytes]]
    notes: list[str]

    def write(self) -> None:
        for file, content in self.files:
            file.parent.mkdir(exist_ok=True)
            write_atomically(file, content)


def check_options(options: ExportOptions) -> None:
    """Unusable if an option has no meaning for the figure."""
    found = []
    if options.step != "depth" and options.depth and len(options.depth) > 1:
        found.append(f"raytree export: --step {options.step} goes through one tree: give one depth")
    if options.step != "depth" and options.figure == "hit":
        found.append(f"raytree export: a hit has no steps: --step {options.step} is for tree, scene and both")
    if options.order != BREADTH and options.step in ("depth", "levels"):
        found.append(f"raytree export: --order {options.order} is for --step rays and colour, got {options.step}")
    if options.sample is not None and options.ray:
        found.append("raytree export: --sample is for a pixel: a ray has no samples")
    given = {item.name for item in fields(options) if getattr(options, item.name) != item.default}
    for name in dict.fromkeys(name for kind in FIGURES for name in kind.options):
        figures = [kind.name for kind in reversed(FIGURES) if name in kind.options]
        if name in given and options.figure not in figures:
            found.append(f"raytree export: --{name} is for --figure {' and '.join(figures)}, got {options.figure}")
    if options.language:
        found.append("raytree export: --language is for --lesson: a figure has no text of its lesson")
    if found:
        raise Unusable(*found)


def make(
    options: ExportOptions,
    world: World,
    scene: str,
    target: Target,
    view: ViewAngles | None = None,
    progress: Callable[[float], None] = lambda share: None,
    embedded: Embedded | None = None,
) -> Made:
    """Make the files that the options ask for.

    `scene` is its name in file names. `view` is the first view that a lesson asks for. `embedded` is what the figures
    carry to be reopened. ValueError or Unusable for options that the scene or the tree does not allow.
    """
    depth = world.scene.tracing.depth
    depths = options.depth or range(depth, depth + 1)
    every = steps_of(world, options, depths)
    steps = chosen(every, options.page)
    check_pages(target, steps)
    # One page is laid out with the last one, the fullest, so that it is the same as among all pages.
    laid_out = steps if options.page is None else [*steps, every[-1]]
    subject = Subject(laid_out, world, orbit_of(options.view, world, view))
    style = style_of(options, steps)
    stem = stem_of(scene, options.pixel)
    drawn = pages(options.figure, subject, style) if any(FORMATS[name].figures for name in target.formats) else []
    drawn = drawn[: len(steps)]
    notes = ray_notes(drawn, options.figure, subject) + fold_notes(drawn, options.figure, subject, style)
    notes += size_notes(drawn, options.figure, style) + sum_notes(drawn, options.figure, subject, style)
    carried, left_out = pack(embedded) if embedded and carries(target) else (b"", [])
    notes += left_out
    files: list[tuple[Path, bytes]] = []
    for name in target.formats:
        kind = FORMATS[name]
        figures = [replace(page, command=command_line(options, name), embedded=carried) for page in drawn]
        if kind.on_screen:
            figures = with_details(with_upright(figures, options.figure, subject, style), steps, world)
        notes += letter_notes(drawn, name)
        for k, group in enumerate(grouped(kind, steps, options.step)):
            progress(len(files) / (len(target.formats) * len(steps)))
            if kind.figures:
                mark = mark_of(group, every, options.step, depths)
                content = kind.write(figures if kind.many_pages else figures[k : k + 1], options.width or PIXELS)
                files.append((target.file(f"{stem}_{options.figure}_{mark}", kind.suffix), content))
            else:
                one = group[-1].tree
                files.append((target.file(f"{stem}_d{one.depth}", kind.suffix), kind.text(one).encode("utf-8")))
    return Made(files, notes)


def chosen(steps: Sequence[Step], page: int | None) -> Sequence[Step]:
    """All pages, or the one that is asked for. Unusable if there is no such page."""
    if page is None:
        return list(steps)
    if page >= len(steps):
        raise Unusable(f"raytree export: --page must be within 0 .. {len(steps) - 1}, got {page}")
    return [steps[page]]


def command_line(options: ExportOptions, format_name: str) -> str:
    """The command that makes the same figure again, without its output."""
    width = options.width if format_name == "png" else None
    same = replace(options, format=(format_name,), width=width)
    return shell_line(["raytree", "export", *words(same, leave_out=("output",))])


def carries(target: Target) -> bool:
    """Whether a file of this export carries the view and its scene."""
    return any(FORMATS[name].suffix in CARRYING for name in target.formats)


def steps_of(world: World, options: ExportOptions, depths: range) -> Sequence[Step]:
    """Trace the trees, and divide them into pages."""
    ray = (options.ray[:3], options.ray[3:]) if options.ray else None
    how = {
        "size": options.size,
        "min_weight": options.min_weight,
        "max_rays": options.max_rays,
        "model": options.model,
        "sample": None if ray else sample_number(world.scene.image.samples, options.sample),
    }
    trees = [tracer.trace(world, options.pixel, ray, depth=depth, **how) for depth in depths]
    if options.turn is not None:
        trees = [_turned(world, tree, options.node, options.turn) for tree in trees]
    steps = _all_steps(trees, options)
    return [of_kinds(step, {*options.filter, "camera"}) for step in steps] if options.filter is not None else steps


def _turned(world: World, tree: RayTree, node: str | None, turn: float) -> RayTree:
    """The tree of the ray that meets this hit at another angle. ValueError if there is none."""
    found = turned(world, tree, hit_row(tree, node), turn)
    if found is None:
        raise ValueError(f"--turn {turn:g}: another surface is in the way of such a ray")
    return found


def _all_steps(trees: Sequence[RayTree], options: ExportOptions) -> Sequence[Step]:
    lights = not options.no_lights and (options.filter is None or "shadow" in options.filter)
    match options.step:
        case "levels":
            return by_level(trees[-1], lights)
        case "rays":
            return by_ray(trees[-1], options.order, lights)
        case "colour":
            return by_color(trees[-1], options.order, lights)
    return by_depth(trees, lights)


def style_of(options: ExportOptions, steps: Sequence[Step]) -> FigureStyle:
    """The style of the figure."""
    return FigureStyle(
        THEMES[options.theme],
        options.text_size,
        swatches=options.swatches or options.step != "depth",  # the colours that are summed up
        fold=options.fold,
        ground=options.ground,
        node=hit_row(steps[-1].tree, options.node) if options.figure == "hit" and options.turn is None else 0,
        is_turned=options.turn is not None,
        eye=options.eye or "top",
        selected=selected_row(options, steps[-1].tree),
        levels=options.levels,
        page=(float(options.paper[0]), float(options.paper[1])),
    )


def selected_row(options: ExportOptions, tree: RayTree) -> int | None:
    """The row of the ray that is to be emphasised. ValueError if the tree does not have it."""
    if options.select is None:
        return None
    row = tree.find(options.select)
    if row is None:
        raise ValueError(f"--select {options.select}: this tree has no such ray")
    return row


def orbit_of(numbers: tuple[float, ...] | None, world: World, view: ViewAngles | None) -> Orbit:
    """The camera of the scene: the numbers of --view, or the view that the window begins with.

    The latter moves back to show the scene's camera as well, if that takes at most the factor FARTHER.
    """
    frame = Frame.of(world)
    if numbers is None:
        orbit = initial_orbit(world, frame, view)
        nearest = orbit.distance
        orbit.fit(frame.inside(world.view().eye)[None])
        if orbit.distance > FARTHER * nearest:  # the subject of the figure would be too small
            orbit.distance = nearest
        return orbit
    azimuth, elevation, distance, *target = numbers
    steep = math.degrees(STEEPEST)
    return orbit_beside(world, frame, azimuth, min(steep, max(-steep, elevation)), distance, target)


def ray_notes(drawn: Sequence[Figure], figure: str, subject: Subject) -> list[str]:
    """Notes on rays that a figure of the scene leaves out because they are too many."""
    tree = subject.steps[-1].tree
    if not drawn or figure not in ("both", "scene"):
        return []
    notes = []
    left_out = many_lights(tree)
    if len(tree) - len(left_out) > MOST_IN_FIGURE:
        of = f"{len(tree) - len(left_out):,} rays"
        notes.append(f"{figure}: of {of}, the heaviest {MOST_IN_FIGURE:,} are drawn in the scene")
    if left_out:
        notes.append(f"{figure}: the rays to {len(tree.scene.lights)} lights are not drawn in the scene")
    return notes


def fold_notes(drawn: Sequence[Figure], figure: str, subject: Subject, style: FigureStyle) -> list[str]:
    """A note on branches that were folded because they do not fit."""
    if style.fold or not any(mark.name.startswith("fold-") for page in drawn for mark in page.marks):
        return []
    where = both.tree_part(style) if figure == "both" else style.canvas
    size = fitting_size(tree.planned(subject.steps), tree.tree_style(subject.steps, style, where))
    helps = f", and --text-size {size:g} shows all branches" if size else ""
    return [f"{figure}: branches that do not fit are folded; a smaller --depth has fewer branches{helps}"]


def sum_notes(drawn: Sequence[Figure], figure: str, subject: Subject, style: FigureStyle) -> list[str]:
    """Notes on sums for which there is no room, or none for text of the usual size."""
    if not drawn or figure not in ("both", "tree"):
        return []
    sizes = []
    for step, page in zip(subject.steps, drawn, strict=False):
        if any(mark.name == f"hit-{step.sum}" for mark in page.marks):  # not in a folded branch
            texts = [mark.size for mark in page.marks if mark.name == f"sum-{step.sum}" and isinstance(mark, Text)]
            sizes.append(min(texts, default=0.0))
    smaller = [size for size in sizes if 0.0 < size < style.text_size]
    notes = []
    if smaller:
        notes.append(f"{figure}: {len(smaller)} of {len(sizes)} sums have smaller text, from {min(smaller):g} points")
    if 0.0 in sizes:
        notes.append(f"{figure}: {sizes.count(0.0)} of {len(sizes)} sums have no room, and are left out")
    return notes


def size_notes(drawn: Sequence[Figure], figure: str, style: FigureStyle) -> list[str]:
    """A note on text that is smaller than asked for, because it does not fit."""
    texts = [mark for page in drawn for mark in page.marks if isinstance(mark, Text) and mark.name[:4] != "sum-"]
    size = min((mark.size for mark in texts), default=style.text_size)
    if size >= style.text_size:
        return []
    return [f"{figure}: text of {style.text_size:g} points does not fit: the tree's has {size:g}"]


def letter_notes(drawn: Sequence[Figure], format_name: str) -> list[str]:
    """A note on letters that a format cannot show."""
    content = "".join(mark.content for page in drawn for mark in page.marks if isinstance(mark, Text))
    missing = FORMATS[format_name].missing_letters(content)
    return (
        [f'{format_name} has no glyph for "{missing}"; svg and pptx use the fonts of the program that shows them']
        if missing
        else []
    )
