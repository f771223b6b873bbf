"""`make screens`: write `docs/window.md`: the window in every mode and theme, each panel alone, with the commands."""

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

from viewer.cli.main import main
from viewer.reopen.view_state import PANEL_NAMES

HEAD = """# The window

Each picture is what its command shows. Made by `make screens`.
"""
LECTURE = "--type-size lecture --panels"
QUALITY = 88  # of WebP


@dataclass(frozen=True)
class Screen:
    """A picture of the window, with the options of `raytree view`."""

    name: str
    title: str
    options: str
    size: str = "1280x720"


SCREENS = (
    Screen("desk", "At the desk", "glass-ball --select TR"),
    Screen("desk-light", "At the desk, light", "glass-ball --select TR --theme light"),
    Screen("desk-large", "At the desk, on a large screen", "underwater --select I", "1920x1080"),
    Screen("lecture", "In the lecture: scene and tree", f"glass-ball --select TR {LECTURE} scene,tree"),
    Screen("lecture-ray", "In the lecture: the selected ray", f"glass-ball --select T {LECTURE} scene,ray"),
    Screen(
        "lecture-hit", "In the lecture: the hit, with the image above it",
        f"underwater --select I {LECTURE} scene,image,hit --theme light",
    ),
    Screen(
        "lecture-lesson", "In the lecture: the lesson",
        f"mirror-balls {LECTURE} scene,lesson --theme light",
    ),
    Screen(
        "lecture-recursion", "In the lecture: the recursion beside the tree",
        f"glass-ball {LECTURE} tree,recursion",
    ),
    Screen(
        "lecture-large", "In the lecture, large screen", f"glass-ball --select TR {LECTURE} scene,tree", "1920x1080"
    ),
    *(
        Screen(f"only-{name}", f"Only this panel: {name}", f"glass-ball --select TR --panels {name}")
        for name in PANEL_NAMES
    ),
)  # fmt: skip


def make(docs: Path) -> None:
    """Write `window.md` and its pictures into the folder `docs`."""
    folder = docs / "window"
    folder.mkdir(parents=True, exist_ok=True)
    page = [HEAD]
    with tempfile.TemporaryDirectory() as place:
        shot = Path(place) / "screen.png"
        for screen in SCREENS:
            words = [*screen.options.split(), "--size", screen.size]
            if main(["view", *words, "--screenshot", str(shot)]) != 0:
                raise SystemExit(1)
            Image.open(shot).convert("RGB").save(folder / f"{screen.name}.webp", quality=QUALITY, method=6)
            page.append(f"## {screen.title}\n\n    raytree view {' '.join(words)}\n")
            page.append(f"![{screen.title}](window/{screen.name}.webp)\n")
    (docs / "window.md").write_text("\n".join(page), "utf-8")


if __name__ == "__main__":
    make(Path(sys.argv[1]))
