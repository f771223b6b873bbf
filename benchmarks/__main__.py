"""`python -m benchmarks [PART...]`: measure, and write bench.json, bench.md and bench.svg.

Exit status 0 even if a figure misses its target: the table says so. 1 if a part could not be run, 2 for invalid
arguments.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks import adaptive, against_embree, against_povray, click, flat, growth, lessons, pick, start, window
from benchmarks.results.against_before import changes
from benchmarks.results.figure import Figure
from benchmarks.results.machine import machine
from benchmarks.results.plot import as_svg, has_library
from benchmarks.results.report import as_json, as_markdown, read_json
from benchmarks.results.task import Options, Task
from viewer.base.files import Unusable, write_atomically
from viewer.base.options import parser_of
from viewer.base.progress import Progress
from viewer.base.values import whole
from viewer.cli.main import Parser

PARTS: dict[str, Callable[[Options], list[Task]]] = {
    "povray": against_povray.times,
    "counts": against_povray.counts,
    "lessons": lessons.times,
    "embree": against_embree.rates,
    "adaptive": adaptive.adaptive,
    "growth": growth.growth,
    "flat": flat.flat,
    "click": click.clicks,
    "start": start.starts,
    "window": window.window,
    "pick": pick.picks,
}


def main(arguments: Sequence[str] | None = None) -> int:
    parser = make_parser()
    chosen = parser.parse_args(arguments)
    if chosen.scenes and not chosen.scenes.is_dir():
        parser.error(f"--scenes: {chosen.scenes} must be a folder")
    try:
        before = read_json(chosen.against) if chosen.against else None
    except (OSError, ValueError) as error:
        parser.error(f"--against: {chosen.against} must be a bench.json: {reason(error)}")
    try:
        chosen.output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        parser.error(f"--output: {chosen.output} must be a folder: {reason(error)}")
    if not has_library():
        print('note: no plot without the extra "bench": python -m pip install -e ".[bench]"', file=sys.stderr)
    options = Options(chosen.runs, chosen.scenes)
    names = [name for name in PARTS if name in chosen.parts or not chosen.parts]
    try:
        figures, failures = measure([(name, task) for name in names for task in PARTS[name](options)])
        found = (figures, failures, machine())
        write_atomically(chosen.output / "bench.json", (as_json(*found, options.runs) + "\n").encode())
        table = as_markdown(*found)
        write_atomically(chosen.output / "bench.md", table.encode())
        if drawn := as_svg(figures):
            write_atomically(chosen.output / "bench.svg", drawn)
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 130
    except Unusable as unusable:
        print(unusable, file=sys.stderr)
        return 2
    print(table)
    if before is not None:
        print(f"Against {chosen.against}:")
        print("\n".join(changes(before, figures)))
    return 1 if failures else 0


def make_parser() -> argparse.ArgumentParser:
    parser = Parser("python -m benchmarks", description="How fast it is, beside other programs.")
    parser.add_argument("parts", nargs="*", type=part, metavar="PART", help=f"of {', '.join(PARTS)}; all")
    parser.add_argument("--runs", type=parser_of(whole(1)), default=5, metavar="N", help="of everything, in turn (5)")
    parser.add_argument("--scenes", type=Path, metavar="FOLDER", help="with NAME.nff and NAME.pov or pov/NAME.pov, too")
    parser.add_argument("--output", type=Path, default=Path("out"), metavar="FOLDER", help="for what is written (out)")
    parser.add_argument(
        "--against", type=Path, metavar="OLD.json", help="say what changed since by more than its spread"
    )
    return parser


def part(name: str) -> str:
    if name not in PARTS:
        raise argparse.ArgumentTypeError(f'a part must be one of {", ".join(PARTS)}, got "{name}"')
    return name


def measure(tasks: Sequence[tuple[str, Task]]) -> tuple[list[Figure], dict[str, str]]:
    """The figures of every task, and the reasons for tasks that failed. A failure does not stop the others."""
    figures: list[Figure] = []
    failures: dict[str, str] = {}
    total = sum(task.seconds for _, task in tasks)
    done = 0.0
    with Progress("measuring") as progress:
        for part, task in tasks:
            progress.doing = f"{part}, {task.name}"
            progress(done / total)
            try:
                figures += task.measure()
            except Exception as error:  # any error: the other tasks still run
                failures[f"{part}, {task.name}"] = reason(error)
            done += task.seconds
    return figures, failures


def reason(error: Exception) -> str:
    """The error in one line: a compiler's message has thousands."""
    first = str(error).strip().partition("\n")[0]
    return f"{type(error).__name__}: {first[:300]}"


if __name__ == "__main__":
    sys.exit(main())
