"""How long libraries take to import, each on top of what a start of the tracer has imported anyway.

Measured where nothing is imported yet: in processes of their own.
"""

import statistics
import subprocess
import sys
from collections.abc import Sequence

STARTS = 3

PROGRAM = """
import sys, time, importlib
before = time.perf_counter()
import tracer
print(time.perf_counter() - before)
for group in sys.argv[1:]:
    before = time.perf_counter()
    try:
        for name in group.split(","):
            importlib.import_module(name)
    except ImportError:
        before = float("nan")
    print(time.perf_counter() - before)
"""


def import_seconds(*groups: Sequence[str]) -> list[float]:
    """Seconds, medians: for the tracer itself, then for each group of modules; nan for what is not installed."""
    command = [sys.executable, "-c", PROGRAM, *(",".join(group) for group in groups)]
    starts = []
    for _ in range(STARTS):
        run = subprocess.run(command, capture_output=True, text=True, check=True)
        starts.append([float(line) for line in run.stdout.split()])
    return [statistics.median(column) for column in zip(*starts, strict=True)]
