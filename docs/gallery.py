"""`make gallery`: write `docs/figures.md`, with figures of every lesson and the commands that made them."""

import sys
from pathlib import Path

from viewer.cli.main import main
from viewer.lessons import lesson

SHOWN = ("both", "hit")
EXTRA = (
    ("glass-ball", ["--figure", "tree", "--swatches", "--theme", "dark"], "tree"),
    ("glass-ball", ["--figure", "tree", "--depth", "1"], "tree"),
    ("underwater", ["--figure", "scene", "--theme", "mono"], "scene"),
)
HEAD = """# Figures

What `raytree export` writes, for each lesson at the pixel it opens with. Made by `make gallery`.
"""


def make(docs: Path) -> None:
    """Write `figures.md` and its pictures into the folder `docs`."""
    folder = docs / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    page = [HEAD]
    for name in lesson.names():
        page.append(f"## {lesson.read(name).title}\n")
        page += [_shown(folder, name, ["--figure", figure], figure) for figure in SHOWN]
        page += [_shown(folder, owner, options, figure) for owner, options, figure in EXTRA if owner == name]
    (docs / "figures.md").write_text("\n".join(page), "utf-8")


def _shown(folder: Path, name: str, options: list[str], figure: str) -> str:
    words = ["export", name, *options, "--ground"]
    count = len([word for word in options if word not in ("--figure", figure)])
    path = folder / f"{name}-{figure}{f'-{count}' if count else ''}.svg"
    if main([*words, "-o", str(path)]) != 0:
        raise SystemExit(1)
    return f"    raytree {' '.join(words)} -o {path.name}\n\n![{figure} of {name}](figures/{path.name})\n"


if __name__ == "__main__":
    make(Path(sys.argv[1]))
