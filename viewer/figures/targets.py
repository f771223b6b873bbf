"""The files of an export: one file, or a folder for files with generated names; and the pages of each file."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from viewer.base.files import Unusable, check_folder, check_writable, has_folder
from viewer.figures.catalogue import FORMATS, PICTURES, FormatKind, format_of
from viewer.figures.export_options import ExportOptions
from viewer.figures.steps import Step


@dataclass(frozen=True)
class Target:
    """One file, or a folder for files with generated names; and the formats to write."""

    path: Path
    is_folder: bool
    formats: tuple[str, ...]

    def file(self, stem: str, suffix: str) -> Path:
        """The file for a page or several pages."""
        return self.path / f"{stem}{suffix}" if self.is_folder else self.path


def target_of(options: ExportOptions) -> Target:
    """The target that the options name. Raises Unusable if output and format contradict each other or cannot be
    written.
    """
    path = Path(options.output)
    is_folder = has_folder(path) or options.output.endswith(("/", "\\"))
    formats = options.format
    if is_folder:
        check_folder(path)
    else:
        own = format_of(path.suffix)
        if own is None and not path.suffix and formats:
            raise Unusable(f'raytree export: a folder\'s name ends with "/": -o {path}/')
        if own is None:
            raise Unusable(f"{path}: must end with one of {', '.join(kind.suffix for kind in FORMATS.values())}")
        if formats and formats != (own,):
            raise Unusable(f"{path}: is {own}, but --format asks for {','.join(formats)}: name a folder, or one format")
        formats = (own,)
        check_writable(path)
    formats = formats or ("svg",)
    if options.width and "png" not in formats:
        raise Unusable(f"raytree export: --width is for png, got {','.join(formats)}")
    return Target(path, is_folder, formats)


def check_pages(target: Target, steps: Sequence[Step]) -> None:
    """Unusable if one file cannot hold all pages."""
    if not target.is_folder and len(steps) > 1 and not FORMATS[target.formats[0]].many_pages:
        titles = [FORMATS[name].title for name in PICTURES if FORMATS[name].many_pages]
        formats = f"{', '.join(titles[:-1])} and {titles[-1]}"
        raise Unusable(f"{target.path}: {len(steps)} pages need a folder, or one of {formats}")


def grouped(kind: FormatKind, steps: Sequence[Step], step: str) -> list[Sequence[Step]]:
    """The pages of each file: all in one if the format has pages. A tree's data is written once, for the whole tree."""
    if kind.many_pages:
        return [steps]
    return [steps[-1:]] if kind.data and step != "depth" else [[one] for one in steps]


def mark_of(group: Sequence[Step], steps: Sequence[Step], step: str, depths: range) -> str:
    """The part of a file's name that tells it from the other files: d2, d0-3, d3_r05, d3_rays."""
    if step == "depth":
        return group[0].name if len(group) == 1 else f"d{depths[0]}-{depths[-1]}"
    return f"d{depths[-1]}_{group[0].name if len(group) == 1 and len(steps) > 1 else step}"


def stem_of(scene: str, pixel: tuple[int, int] | None) -> str:
    """The first part of a file's name."""
    return f"{scene}_{pixel[0]}_{pixel[1]}" if pixel else f"{scene}_ray"
