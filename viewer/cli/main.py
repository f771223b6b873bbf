"""The command line: the list of commands, and the parser made from their options.

A command's module is imported when the command is run, so that `--help` and errors stay fast.
"""

import argparse
import difflib
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, NoReturn

from viewer.base.files import Unusable, remove_stale_parts
from viewer.base.interruption import Interrupted, interruptible
from viewer.base.options import add_arguments, joined, options_of, valued_flags
from viewer.base.streams import ReaderGone, put, put_error
from viewer.cli import options
from viewer.figures.export_options import ExportOptions


@dataclass(frozen=True)
class Command:
    """A command. Its function takes the options and returns the exit status."""

    name: str
    help: str
    options: type
    function: str  # "module:function"


COMMANDS = (
    Command(
        "view", "the viewer (the default), on the first lesson if no scene is given", options.ViewOptions,
        "viewer.cli.view:view",
    ),
    Command("trace", "the ray tree behind one pixel", options.TraceOptions, "viewer.cli.trace:trace"),
    Command(
        "render", "a scene's image into a file, or the images of several into a folder", options.RenderOptions,
        "viewer.cli.render:render",
    ),
    Command(
        "export", "a pixel's ray tree as figures for slides, and as data", ExportOptions, "viewer.cli.export:export"
    ),
    Command(
        "report", "error against run time, for each source of error", options.ReportOptions, "viewer.cli.report:report"
    ),
    Command(
        "plan", "the capabilities that a scene needs, and those left out", options.PlanOptions, "viewer.cli.plan:plan"
    ),
    Command(
        "check", "numbers against exact answers: cases where textbook formulas fail", options.CheckOptions,
        "viewer.cli.check:check",
    ),
    Command(
        "lessons", "the lessons, one per line; the check of a lesson; a new one", options.LessonsOptions,
        "viewer.cli.lessons:lessons",
    ),
)  # fmt: skip


class Parser(argparse.ArgumentParser):
    """Reports an error in one line and exits with 2. Options cannot be abbreviated."""

    def __init__(self, *arguments: Any, **settings: Any) -> None:
        super().__init__(*arguments, allow_abbrev=False, **settings)
        self.color = False  # Python 3.14 colours its help, with control characters

    def error(self, message: str) -> NoReturn:
        put_error(f"{self.prog}: {message} (see {self.prog} --help)")
        self.exit(2)

    def print_help(self, file: Any = None) -> None:
        """Write the help to standard output."""
        put(self.format_help())


def program() -> NoReturn:
    """Run `main`, and exit without Python's own cleaning up, which takes a fifth of a second and would write what could
    not be written once more.
    """
    try:
        status = main()
    except SystemExit as end:  # --help, --version, wrong arguments
        status = end.code if isinstance(end.code, int) else 0
    os._exit(status)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. Returns its exit status: 0 success, 1 a check failed, 2 unusable input or arguments, or output
    that cannot be written.
    """
    try:
        with interruptible():
            command, chosen = parse(sys.argv[1:] if arguments is None else arguments)
            remove_stale_parts(Path())
            return resolve_name(command.function)(chosen)
    except Unusable as unusable:
        for fault in unusable.faults:
            put_error(fault)
        return 2
    except ReaderGone:
        return 0
    except Interrupted as asked:
        put_error("stopped")
        status = asked.status
        sys.unraisablehook = lambda _: None  # what a compiler was doing may fail to clean up
    # The exception is gone, and with its frames what they held, like the semaphores of worker processes.
    os._exit(status)  # at once: Python would wait for threads in C code of libraries


def parse(arguments: Sequence[str]) -> tuple[Command, Any]:
    """The command and its options. Exits with 2 if the arguments are not allowed."""
    parser = make_parser()
    names = [command.name for command in COMMANDS]
    if arguments and not arguments[0].startswith("-") and arguments[0] not in names:
        close = difflib.get_close_matches(arguments[0], names, 1)
        hint = close[0] if close else f"view {arguments[0]}"
        parser.error(f'no command "{arguments[0]}": did you mean "raytree {hint}"?')
    parsed = parser.parse_args(joined(arguments, valued_flags(command.options for command in COMMANDS)))
    if parsed.command is None:
        return COMMANDS[0], COMMANDS[0].options()
    command = COMMANDS[names.index(parsed.command)]
    return command, options_of(command.options, parsed)


class PrintVersion(argparse.Action):
    """`--version`. Looks the version up only when asked: that takes a third of the time of a start."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        put(f"raytree {version('raytree')}\n")
        parser.exit()


def make_parser() -> Parser:
    """The parser of all commands."""
    parser = Parser(prog="raytree", description="Why is that pixel this colour? The tree of rays behind it.")
    parser.add_argument("--version", action=PrintVersion, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=Parser)
    for command in COMMANDS:
        add_arguments(commands.add_parser(command.name, help=command.help), command.options)
    return parser
