# The README's two commands are `make run` and `make test`. Everything is installed in .venv, except the system packages
# that tests need; those are installed only as root or with sudo.

PYTHON ?= $(firstword $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p; done))
BIN := .venv/bin

# Programs that tests use: an X server without a monitor, xdotool for its mouse, a window manager, OpenGL in software,
# POV-Ray as the independent program that images are compared with, and programs that read the files of figures. PROGRAM:PACKAGE, and libraries.
PROGRAMS := Xvfb:xvfb xdotool:xdotool openbox:openbox setxkbmap:x11-xkb-utils povray:povray \
	setpriv:util-linux rsvg-convert:librsvg2-bin pdftotext:poppler-utils chromium:chromium
LIBRARIES := libEGL.so.1:libegl1 libGL.so.1:libgl1 swrast_dri.so:libgl1-mesa-dri

# Programs for `make test-all` only: an office program and TeX, which open exported files.
OFFICE := soffice:libreoffice-impress pdflatex:texlive-latex-extra kpsewhich:texlive-pictures

# Two processes, each with whole files of tests, those of long tests first (`tests/conftest.py`). The kernels are
# compiled before, so that not both do it.
SIDE_BY_SIDE := -n 2 --dist loadfile --no-loadscope-reorder

.PHONY: run test test-all check bench bench-quick bench-stable picture screens gallery formulas clean

run: .venv/installed
	@$(BIN)/raytree

test: .venv/installed-dev
	@sh .ci/system-packages '$(PROGRAMS)' '$(LIBRARIES)'
	$(BIN)/python -c 'from tracer.image.warmup import fill_cache; fill_cache()'
	$(BIN)/python -m pytest -q $(SIDE_BY_SIDE)

# Also the slow tests: those with an office program and TeX, which take hundreds of megabytes, those that compile
# more kernels, and more of the same.
test-all: .venv/installed-dev
	@sh .ci/system-packages '$(PROGRAMS) $(OFFICE)' '$(LIBRARIES)'
	$(BIN)/python -m pytest -q $(SIDE_BY_SIDE) -m ''

check: .venv/installed-dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/pyright --pythonpath $(BIN)/python

# Speed, side by side with POV-Ray and Embree: a table, a plot and the figures as JSON in out/. More scenes, parts, runs:
# make bench BENCH='povray --scenes FOLDER --runs 9'
bench: .venv/installed-bench
	@sh .ci/system-packages '$(PROGRAMS)' '$(LIBRARIES)'
	$(BIN)/python -m benchmarks $(BENCH)

# The effect of a change on speed, in two minutes: compared with the figures of the last `make bench`, if there are any.
bench-quick: .venv/installed-bench
	@sh .ci/system-packages '$(PROGRAMS)' '$(LIBRARIES)'
	$(BIN)/python -m benchmarks povray embree growth --runs 3 --output out/quick $(addprefix --against ,$(wildcard out/bench.json))

# The cost of the stable formulas, against the textbook's in the same kernel.
bench-stable: .venv/installed-dev
	$(BIN)/python -m benchmarks.against_textbook

# The README's picture of the viewer, by the viewer.
picture: .venv/installed
	$(BIN)/raytree view glass-ball --screenshot docs/viewer.png

# The window in every mode, theme and panel: docs/window.md with its pictures.
screens: .venv/installed
	$(BIN)/python -m docs.screens docs

# The gallery of figures: docs/figures.md with its pictures.
gallery: .venv/installed
	$(BIN)/python -m docs.gallery docs

# The lecture's formulas as outlines, in viewer/figures/formula/outlines.json: after a change in viewer/explain/formulas.py.
formulas: .venv/installed
	$(BIN)/python -m viewer.figures.formula.shipping

.venv/installed: pyproject.toml
	@test -n "$(PYTHON)" || { echo "raytree needs Python 3.11 or later: no python3 of that version was found"; exit 1; }
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e .
	@touch $@

.venv/installed-dev: .venv/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[dev]'
	@touch $@

.venv/installed-bench: .venv/installed-dev
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[bench]'
	@touch $@

clean:
	rm -rf .venv out .pytest_cache .ruff_cache .hypothesis
