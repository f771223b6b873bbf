"""The machine that figures were measured on. Without it they mean little."""

import importlib.metadata
import platform
import re
import shutil
import subprocess

from tracer.image.render import processors
from tracer.measure.conditions import Moment, processor_model

PACKAGES = ("numpy", "numba", "embreex")


def machine() -> dict[str, str | int]:
    """The machine and its versions, and date and load at the end of the measurement."""
    ended = Moment()
    return {
        "ended": ended.utc,
        "load average at the end": ", ".join(f"{load:.2f}" for load in ended.load) if ended.load else "unknown",
        "processor": processor_model(),
        "cores": processors(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
        "povray": povray_version(),
    }


def version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "none"


def povray_version() -> str:
    if not shutil.which("povray"):
        return "none"
    said = subprocess.run(["povray", "--version"], capture_output=True, text=True, check=False)
    found = re.search(r"POV-Ray (\d[\w.]*)", said.stdout + said.stderr)
    return found.group(1) if found else "unknown"
