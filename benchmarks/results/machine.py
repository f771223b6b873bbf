"""The machine that figures were measured on. Without it they mean little."""

import importlib.metadata
import platform
import re
import shutil
import subprocess
from pathlib import Path

from tracer.image.render import processors

PACKAGES = ("numpy", "numba", "embreex")


def machine() -> dict[str, str | int]:
    return {
        "processor": processor(),
        "cores": processors(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
        "povray": povray_version(),
    }


def processor() -> str:
    about = Path("/proc/cpuinfo")
    found = re.search(r"model name\s*:\s*(.+)", about.read_text()) if about.exists() else None
    return found.group(1) if found else platform.processor() or "unknown"


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
