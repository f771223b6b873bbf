"""Generated scenes, of the kinds that ray tracers have been compared on since 1987.

After the kinds of E. Haines' Standard Procedural Databases ("A Proposal for Standard Graphics Environments", IEEE
CG&A 7(11), 1987), each written anew. A generator returns the text of an NFF file; its arguments make it smaller for
tests.
"""

from collections.abc import Callable

from benchmarks.scenes.lattice import lattice
from benchmarks.scenes.mountain import mountain
from benchmarks.scenes.patches import patches
from benchmarks.scenes.rings import rings
from benchmarks.scenes.sphereflake import sphereflake

SCENES: dict[str, Callable[[], str]] = {
    "sphereflake": sphereflake,
    "mountain": mountain,
    "rings": rings,
    "lattice": lattice,
    "patches": patches,
}
