"""Where an export goes: one file, or a folder with names of ours; and which pages stand in which file."""

from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path

from viewer.base.files import Unusable, check_folder, check_writable
from viewer.figures.formats import FORMATS, Format, format_of
from viewer.figures.steps import Stage
from viewer.lessons.lesson import Lesson


@dataclass(frozen=True)
class Target:
    """Where the files go: into a folder under names of ours, or one file."""

    path: Path
    folder: bool

    def file(self, stem: str, suffix: str) -> Path:
        return self.path / f"{stem}{suffix}" if self.folder else self.path


def chosen(options: Namespace) -> tuple[Target, list[str]]:
    """Where to and as what; Unusable where the two do not agree."""
    path = Path(options.output)
    folder = path.is_dir() or options.output.endswith(("/", "\\"))
    formats = options.format
    if not folder:
        own = format_of(path.suffix)
        if own is None and not path.suffix and formats:
            raise Unusable(f'raytree export: a folder\'s name ends with "/": -o {path}/')
        if own is None:
            raise Unusable(f"{path}: must end with one of {', '.join(kind.suffix for kind in FORMATS.values())}")
        if formats and formats != [own]:
            raise Unusable(f"{path}: is {own}, but --format asks for {','.join(formats)}: name a folder, or one format")
        formats = [own]
        check_writable(path)
    else:
        check_folder(path)
    formats = formats or ["svg"]
    if options.width and "png" not in formats:
        raise Unusable(f"raytree export: --width is for png, got {','.join(formats)}")
    return Target(path, folder), formats


def check_pages(target: Target, formats: list[str], stages: list[Stage]) -> None:
    if not target.folder and len(stages) > 1 and not FORMATS[formats[0]].many_pages:
        raise Unusable(f"{target.path}: {len(stages)} pages need a folder, or one of PDF and PPTX")


def grouped(kind: Format, stages: list[Stage], step: str) -> list[list[Stage]]:
    """The pages of each file: all in one where the format has pages; data is of a whole tree."""
    if kind.many_pages:
        return [stages]
    return [stages[-1:]] if kind.data and step != "depth" else [[stage] for stage in stages]


def mark_of(group: list[Stage], stages: list[Stage], step: str, depths: range) -> str:
    """What tells a file from the others: d2, d0-3, d3_r05, d3_rays."""
    if step == "depth":
        return group[0].name if len(group) == 1 else f"d{depths[0]}-{depths[-1]}"
    return f"d{depths[-1]}_{group[0].name if len(group) == 1 and len(stages) > 1 else step}"


def stem_of(options: Namespace, lesson: Lesson | None) -> str:
    scene = lesson.name if lesson else Path(options.scene).stem
    return f"{scene}_{options.pixel[0]}_{options.pixel[1]}" if options.pixel else f"{scene}_ray"
