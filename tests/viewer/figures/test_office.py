"""Files opened by an office program and by TeX. Not in `make test`: the programs take hundreds of megabytes."""

import re
import subprocess
from pathlib import Path

import pytest

import tracer
from tests.conftest import LESSONS
from viewer.base.orbit import Frame, initial_orbit
from viewer.figures.catalogue import FIGURE_NAMES
from viewer.figures.marks import Figure, Text
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.figures.writers.pptx import write_pptx
from viewer.figures.writers.tikz import write_tikz
from viewer.lessons import lesson

pytestmark = [pytest.mark.office, pytest.mark.timeout(600)]


def figures(worlds: dict[str, tracer.World], name: str, kind: str) -> list[Figure]:
    found = lesson.read(name)
    stages = by_depth([tracer.trace(worlds[name], found.first.state.pixel, depth=d) for d in range(4)])
    orbit = initial_orbit(worlds[name], Frame.of(worlds[name]), found.first.state.view)
    return pages(kind, Subject(stages, worlds[name], orbit), FigureStyle(swatches=True))


def said(pdf: Path) -> str:
    return subprocess.run(["pdftotext", "-raw", pdf, "-"], capture_output=True, text=True, check=True).stdout


def words(figure: Figure) -> list[str]:
    return [mark.content for mark in figure.marks if isinstance(mark, Text)]


def test_an_office_program_opens_every_pptx(worlds: dict[str, tracer.World], tmp_path: Path) -> None:
    """As many slides as depths, and all text on its slide."""
    made = {f"{name}-{kind}": figures(worlds, name, kind) for name in LESSONS for kind in FIGURE_NAMES}
    for name, found in made.items():
        (tmp_path / f"{name}.pptx").write_bytes(write_pptx(found))
    command = ["soffice", f"-env:UserInstallation=file://{tmp_path}/profile", "--headless", "--convert-to", "pdf"]
    subprocess.run([*command, "--outdir", tmp_path, *tmp_path.glob("*.pptx")], check=True, capture_output=True)
    for name, found in made.items():
        slides = said(tmp_path / f"{name}.pdf").split("\f")
        assert len(slides) == len(found) + 1
        for figure, slide in zip(found, slides, strict=False):
            flat = re.sub(r"\s+", "", slide)
            for word in words(figure):
                assert re.sub(r"\s+", "", word) in flat, (name, word)


BEAMER = r"""\documentclass[aspectratio=169]{beamer}
\usepackage[T1]{fontenc}
\usepackage{tikz,standalone}
\begin{document}
\begin{frame}\resizebox{\textwidth}{!}{\input{figure}}\end{frame}
\end{document}
"""


@pytest.mark.parametrize("kind", FIGURE_NAMES)
def test_tikz_compiles_alone_and_in_beamer(worlds: dict[str, tracer.World], tmp_path: Path, kind: str) -> None:
    for name in LESSONS:
        figure = figures(worlds, name, kind)[-1]
        (tmp_path / "figure.tex").write_bytes(write_tikz(figure))
        (tmp_path / "slides.tex").write_text(BEAMER)
        for document in ("figure", "slides"):
            command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", document]
            run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, errors="replace", check=False)
            assert run.returncode == 0, run.stdout[-2000:]
            text = re.sub(r"\s+", "", said(tmp_path / f"{document}.pdf"))
            for word in words(figure):
                for part in re.findall(r"[A-Za-z]{3,}", word):
                    # Beamer's bitmap fonts have ligatures that pdftotext does not read as letters.
                    assert part in text or re.search("f[fil]", part), (name, document, part)
