"""The extras of pyproject.toml: optional libraries, and the command that installs them."""

import json
import sys
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname


class MissingExtra(ImportError):
    """A library of an extra is not installed."""


def missing_extra(what: str, extra: str) -> str:
    """One line for the user, about what needs the extra, like "a cluster needs"."""
    return f"{what} the extra raytree[{extra}]: {install_command(extra)}"


def install_command(extra: str) -> str:
    """The command that installs an extra into this environment, from the folder raytree was installed from."""
    source, option = "raytree", ""
    try:
        url = json.loads(distribution("raytree").read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        url = {}
    if url.get("url", "").startswith("file:"):
        source = shortened(url2pathname(urlparse(url["url"]).path))
        option = "-e " if url.get("dir_info", {}).get("editable") else ""
    return f'{shortened(sys.executable)} -m pip install {option}"{source}[{extra}]"'


def shortened(path: str) -> str:
    """A path relative to the working directory, if it lies in it."""
    here = Path.cwd()
    return str(Path(path).relative_to(here)) if Path(path).is_relative_to(here) else path
