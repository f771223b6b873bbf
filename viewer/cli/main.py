"""The command line: what can be said, and nothing else. What is then done stands in `commands`, loaded when needed."""

import argparse
import contextlib
import difflib
import os
import re
import sys
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any, NoReturn

from viewer.base.interruption import Interrupted, interruptible
from viewer.cli.values import (
    above_zero,
    at_least,
    depths,
    listed,
    pair,
    pixels,
    ray_name,
    share,
    six,
    text_size,
    view_from,
    weight,
)

COMMANDS = ("view", "trace", "render", "export", "report", "plan", "check", "lessons")
FORMATS = ("text", "json", "csv", "dot")
FIGURES = ("tree", "scene", "both", "hit")
FILES = ("svg", "pdf", "png", "tikz", "pptx", "dot", "csv", "json", "text")

# Options whose value may begin with a minus sign, which argparse would take for another option.
NUMERIC = ("--ray", "--pixel", "--size", "--view")


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line and leaves with 2. Options are not guessed from their first letters."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, allow_abbrev=False, **options)

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


def program() -> NoReturn:
    """`main`, and leave at once: to take apart what the system takes back anyway takes Python a fifth of a second."""
    status = main()
    with contextlib.suppress(BrokenPipeError):  # the reader of our output has seen enough
        sys.stdout.flush()
    os._exit(status)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; its exit status: 0 done, 1 a check fell short, 2 unusable input or arguments."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    parser = make_parser()
    if given and not given[0].startswith("-") and given[0] not in COMMANDS:
        close = difflib.get_close_matches(given[0], COMMANDS, 1)
        parser.error(f'no command "{given[0]}": did you mean "raytree {close[0] if close else f"view {given[0]}"}"?')
    options = parser.parse_args(_joined(given))
    try:
        with interruptible():
            return run(options)
    except Interrupted as asked:
        print("stopped", file=sys.stderr, flush=True)
        os._exit(asked.status)  # at once: a thread in a library's C code would be waited for, and none is needed


def run(options: argparse.Namespace) -> int:
    from viewer.base.files import Unusable
    from viewer.cli import commands

    command = getattr(commands, options.command or "view")
    try:
        return command(options)
    except Unusable as unusable:
        print(unusable, file=sys.stderr)
        return 2
    except BrokenPipeError:  # the reader of our output has seen enough
        sys.stderr.close()
        return 0


def make_parser() -> Parser:
    parser = Parser(prog="raytree", description="Why is that pixel this colour? The tree of rays behind it.")
    parser.add_argument("--version", action="version", version=f"raytree {version('raytree')}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=Parser)
    parser.set_defaults(scene=None, pixel=None, depth=None, model=None, screenshot=None, size=None)

    view = commands.add_parser("view", help="the viewer (the default), on the first lesson if no scene is given")
    view.add_argument("scene", nargs="?", metavar="SCENE", help=SCENE_HELP)
    view.add_argument("--pixel", type=pair(","), metavar="X,Y", help="pick this pixel, counted from the top left")
    _add_depth(view)
    _add_model(view)
    view.add_argument("--screenshot", type=Path, metavar="FILE.png", help="draw the viewer into a file and leave")
    view.add_argument("--size", type=pair("x"), metavar="WxH", help="of the window or the screenshot")

    trace = commands.add_parser("trace", help="the ray tree behind one pixel")
    trace.add_argument("scene", metavar="SCENE", help=SCENE_HELP)
    where = trace.add_mutually_exclusive_group(required=True)
    where.add_argument("--pixel", type=pair(","), metavar="X,Y", help="counted from the image's top left")
    where.add_argument("--ray", type=six, metavar="ox,oy,oz,dx,dy,dz", help="origin and direction of a ray")
    _add_limits(trace)
    trace.add_argument("--size", type=pair("x"), metavar="WxH", help="of the image, the scene's own by default")
    trace.add_argument("--format", choices=FORMATS, default="text", help="text by default")
    trace.add_argument(
        "--rays",
        type=at_least(0),
        default=300,
        metavar="N",
        help="text: show the N heaviest, 300 by default; 0 for all",
    )
    trace.add_argument("-o", "--output", type=Path, metavar="FILE", help="write there instead of the terminal")

    render = commands.add_parser("render", help="a scene's image into a file, or the images of several into a folder")
    render.add_argument("scene", nargs="+", metavar="SCENE", help=SCENE_HELP)
    render.add_argument(
        "-o", "--output", required=True, metavar="FILE|FOLDER/", help=".png, .npy or .exr; a folder for several scenes"
    )
    render.add_argument("--format", choices=("png", "npy", "exr"), help="of the files in a folder, png by default")
    _add_limits(render)
    render.add_argument("--size", type=pair("x"), metavar="WxH", help="of the image, the scene's own by default")
    render.add_argument(
        "--samples",
        type=at_least(1),
        metavar="N",
        help="a pixel; 1, its centre, by default; at most, with one of these:",
    )
    render.add_argument(
        "--sampler",
        choices=("sobol", "random", "jittered"),
        default="sobol",
        help="where they lie; jittered: N is a square",
    )
    render.add_argument(
        "--until-error", type=above_zero, metavar="E", help="samples where the error is, until it is estimated as E"
    )
    render.add_argument("--until-seconds", type=above_zero, metavar="S", help="the same, until S seconds have passed")
    where = render.add_mutually_exclusive_group()
    where.add_argument("--threads", type=at_least(1), metavar="N", help="as many as processors by default")
    where.add_argument("--dask", metavar="tcp://HOST:PORT", help="trace on the Dask cluster of this scheduler")
    render.add_argument("--stats", type=Path, metavar="FILE.json", help="times, ray counts and what was left out")

    export = commands.add_parser("export", help="a pixel's ray tree as figures for slides, and as data")
    export.add_argument("scene", metavar="SCENE", help=SCENE_HELP)
    where = export.add_mutually_exclusive_group()
    where.add_argument(
        "--pixel", type=pair(","), metavar="X,Y", help="from the image's top left; a lesson's own by default"
    )
    where.add_argument("--ray", type=six, metavar="ox,oy,oz,dx,dy,dz", help="origin and direction of a ray")
    export.add_argument("--figure", choices=FIGURES, default="tree", help="tree by default")
    export.add_argument(
        "--view",
        type=view_from,
        metavar="A,E,D[,X,Y,Z]",
        help="scene: degrees from its camera's side and above, distance in its radii, what is looked at",
    )
    export.add_argument("--node", type=ray_name, metavar="T4", help="hit: of this ray; the first by default")
    export.add_argument("--depth", type=depths, metavar="D|A..B", help="recursion depth, or a page a depth: 0..3")
    export.add_argument(
        "--step", choices=("depth", "rays", "colour"), default="depth",
        help="a page a depth; a ray, as they are traced; or a hit, as colour flows back",
    )  # fmt: skip
    _add_model(export)
    _add_min_weight(export)
    export.add_argument("--size", type=pair("x"), metavar="WxH", help="of the image, the scene's own by default")
    export.add_argument("--format", type=listed(FILES), metavar="A,B", help=f"of {', '.join(FILES)}; svg by default")
    export.add_argument("--theme", choices=("light", "dark", "mono"), default="light", help="light by default")
    export.add_argument("--swatches", action="store_true", help="the colour that each ray sends up, in its box")
    export.add_argument(
        "--fold", type=share, default=0.0, metavar="W", help="fold branches that weigh less into one box"
    )
    export.add_argument(
        "--text-size", type=text_size, default=18.0, metavar="PT", help="points on a slide; 18 by default"
    )
    export.add_argument("--eye", choices=("top", "left"), help="tree: where it begins; on top by default")
    export.add_argument("--no-lights", action="store_true", help="leave out the rays to the lights")
    export.add_argument("--ground", action="store_true", help="on the theme's ground; transparent by default")
    export.add_argument("--width", type=pixels, metavar="PX", help="PNG: pixels across; 1920 by default")
    export.add_argument(
        "-o", "--output", required=True, metavar="FILE|FOLDER/", help="names in a folder: SCENE_X_Y_FIGURE_dD.EXT"
    )

    report = commands.add_parser("report", help="error against run time, for each source of error")
    report.add_argument("scene", nargs="?", metavar="SCENE", help=SCENE_HELP)
    report.add_argument("--all", action="store_true", help="every lesson, and stiff trees with exact answers")
    report.add_argument(
        "--size", type=pair("x"), metavar="WxH", help="of its images; some 240 pixels across by default"
    )
    report.add_argument("--quick", action="store_true", help="fewer settings on smaller images: under a minute")
    report.add_argument("-o", "--output", required=True, metavar="FOLDER", help="for the page, its plots and its data")

    plan = commands.add_parser("plan", help="what a scene needs of the tracer, and what is left out")
    plan.add_argument("scene", metavar="SCENE", help=SCENE_HELP)
    plan.add_argument(
        "--measure", action="store_true", help="with and without, in turn: rays and time; some 20 seconds"
    )
    plan.add_argument("--json", action="store_true", help="for programs: one document")

    check = commands.add_parser("check", help="numbers against exact answers: cases where textbook formulas fail")
    check.add_argument("cases", nargs="*", metavar="CASE", help="names like A1, or groups like A; all by default")
    check.add_argument("--explain", action="store_true", help="what goes wrong in the textbook's way, every setting")
    check.add_argument("--json", action="store_true", help="for programs: one document")

    commands.add_parser("lessons", help="the lessons, one a line")
    return parser


SCENE_HELP = "a .toml, .nff, .obj, .ply, .stl or .glb file, or a lesson's name"


def _add_depth(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--depth", type=at_least(0), metavar="D", help="recursion depth, the scene's own by default")


def _add_model(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--model", choices=("whitted", "fresnel"), help="the scene's own by default")


def _add_min_weight(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--min-weight", type=weight, default=0.0, metavar="W", help="do not follow rays that weigh less"
    )


def _add_limits(parser: argparse.ArgumentParser) -> None:
    _add_depth(parser)
    _add_model(parser)
    _add_min_weight(parser)
    parser.add_argument(
        "--tolerance",
        type=weight,
        metavar="T",
        help="follow the heaviest rays first, to any depth, until those left weigh no more than T in sum",
    )


def _joined(arguments: list[str]) -> list[str]:
    """`--ray -1,0,0,...` as `--ray=-1,0,0,...`."""
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1] in NUMERIC and re.match(r"-[\d.]", argument):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined
