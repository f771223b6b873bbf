"""The command that installs an extra names this Python and this folder, from wherever it is printed."""

import shlex
import sys
import tomllib
from pathlib import Path

import pytest

from tracer.extras import install_command, missing_extra

ROOT = Path(__file__).parents[2]
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]


@pytest.mark.parametrize("here", [ROOT, ROOT / "docs", ROOT.parent])
@pytest.mark.parametrize("extra", EXTRAS)
def test_the_command_for_an_extra(here: Path, extra: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(here)
    python, *words, option, source = shlex.split(install_command(extra))
    assert here / python == Path(sys.executable)
    assert [*words, option] == ["-m", "pip", "install", "-e"]
    assert source.endswith(f"[{extra}]")
    assert (here / source.removesuffix(f"[{extra}]")).resolve() == ROOT


def test_a_missing_extra_names_itself_and_the_command() -> None:
    said = missing_extra("a cluster needs", "dask")
    assert said == f"a cluster needs the extra raytree[dask]: {install_command('dask')}"
