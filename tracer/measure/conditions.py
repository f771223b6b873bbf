"""The conditions of a measurement: the processor, the load of the machine, date and time."""

import os
import platform
import re
import time
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from tracer.compile import kernel_cache


@dataclass(frozen=True)
class Moment:
    """A point in time, and the load of the machine then."""

    utc: str = field(default_factory=lambda: datetime.now(UTC).isoformat(timespec="seconds"))  # ISO 8601
    load: tuple[float, float, float] | None = field(default_factory=lambda: load_average())
    clock: float = field(default_factory=time.perf_counter)  # seconds, for differences


def load_average() -> tuple[float, float, float] | None:
    """The mean number of processes that wanted a processor, over 1, 5 and 15 minutes. None where no one counts."""
    try:
        return os.getloadavg()
    except (AttributeError, OSError):
        return None


def processor_model() -> str:
    """The processor's name, as the system has it, and in brackets the compiler's name of its kind."""
    about = Path("/proc/cpuinfo")
    found = re.search(r"model name\s*:\s*(.+)", about.read_text()) if about.exists() else None
    name = found.group(1).strip() if found else platform.processor() or platform.machine()
    kind = kernel_cache.machine()["processor"].partition("/")[0]
    return name if kind == name else f"{name} ({kind})"
