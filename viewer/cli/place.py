"""The place that `trace` and `export` are about: that of the options, else of the lesson's step or of the figure."""

from dataclasses import replace
from typing import TypeVar

from tracer.formulas.vector import Vector
from tracer.kernel.world import World
from viewer.base.files import Unusable
from viewer.cli.options import TraceOptions
from viewer.figures.export_options import ExportOptions
from viewer.lessons.image_place import ray_between
from viewer.reopen.view_state import KINDS
from viewer.session.restore.figure_scene import FigureScene

Options = TypeVar("Options", TraceOptions, ExportOptions)


def with_place(options: Options, scene: FigureScene, command: str) -> Options:
    """The options with what the scene opens with where they have nothing: its pixel, sample, depth and model, and for a
    figure of a lesson's step the kinds of rays and the hit. With another pixel or a ray, a trace has the depth and the
    model of the scene's file, unless a step is asked for. Unusable if there is neither a pixel nor a ray.
    """
    state = scene.state
    is_own = options.at is not None or not (options.pixel or options.ray)
    is_between = bool(scene.between) and not (options.pixel or options.ray)
    if is_between and options.sample is not None:
        raise Unusable(f"raytree {command}: --sample is for a pixel: --swept {state.swept:g} is between pixels")
    if not (options.pixel or options.ray or is_between):
        options = replace(options, pixel=state.pixel)
    if not (options.pixel or options.ray or is_between):
        raise Unusable(f"raytree {command}: give a pixel (--pixel X,Y) or a ray (--ray ox,oy,oz,dx,dy,dz)")
    if options.pixel and options.sample is None:
        options = replace(options, sample=state.sample)
    if options.model is None and is_own:
        options = replace(options, model=state.model)
    if not isinstance(options, ExportOptions):
        return replace(options, depth=state.depth) if options.depth is None and is_own else options
    if not options.depth and state.depth is not None:
        options = replace(options, depth=range(state.depth, state.depth + 1))
    if options.at and options.filter is None and state.filter != KINDS:
        options = replace(options, filter=state.filter)
    if options.at and options.node is None and options.figure == "hit":
        options = replace(options, node=state.select)
    return options


def ray_of(world: World, scene: FigureScene) -> tuple[Vector, Vector] | None:
    """(origin, direction) of the ray of a lesson's sweep that stands between pixels; None if it does not."""
    return ray_between(world, scene.between) if scene.between else None
