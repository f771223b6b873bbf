"""Types of bundles in the list of cached kernels, which every process reads, whatever formulas it computes with."""

import subprocess
import sys
from pathlib import Path

COMMON = """
import pickle, sys, tracer
from pathlib import Path
from tests.scenes import ball, world_of
from tracer.measure.precision.textbook_kernel import textbook_formulas
scene, path = world_of(ball((0, 0, 0), 1)).scene, Path(sys.argv[1])
"""
WRITES = """
world = tracer.prepare(scene, formulas=textbook_formulas("double"))
path.write_bytes(pickle.dumps(world.arrays.numba_type))
"""
READS = """
kind = pickle.loads(path.read_bytes())
table = next(entry.type for entry in kind.entries if entry.name == "formulas")
print(table.functions is None)
formulas = textbook_formulas("double")
print(tracer.prepare(scene, formulas=formulas).arrays.numba_type is kind)
print(table.functions is formulas)
"""


def test_a_cached_type_has_no_functions_until_a_bundle_has_them(tmp_path: Path) -> None:
    """The list has a kernel with the textbook's formulas; a process that does not know them reads it all the same."""
    for program, expected in ((WRITES, []), (READS, ["True", "True", "True"])):
        command = [sys.executable, "-c", COMMON + program, str(tmp_path / "type")]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        assert (run.returncode, run.stdout.split()) == (0, expected), run.stderr
