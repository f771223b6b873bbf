"""Names of rays. A ray has a path, by which files and commands select it, and a label, which is shorter, for eyes.

The path is unique, and the same for every depth limit and number of lights. `E` is the camera ray. Below it, each ray
adds a letter: `T`, `TR`, `TRI`. A shadow ray adds its light: `E.L(key)`, `TR.L(key)`.

The label is the kind of the ray with its number, which counts the rays without shadow rays in the order of the table:
`E`, `R1`, `T2`, `TIR3`. A shadow ray has the label of the ray that it starts from, and its light: `T2.L(key)`.
"""

import re
from collections import Counter

import numpy as np

from tracer.choices import SYMBOLS
from tracer.kernel.nodes import KINDS, SHADOW
from tracer.scene import Scene

LETTERS = SYMBOLS | {"tir": "I"}  # in paths, where each ray has one letter
RESERVED = "()[]{}"  # characters with a meaning in paths


def light_names(scene: Scene) -> list[str]:
    """The name of each light in paths: the author's if it is unique there, else `#` and the light's number."""
    counts = Counter(light.name for light in scene.lights)
    return [
        f"#{j}"
        if not light.name or counts[light.name] > 1 or light.name[0] == "#" or set(light.name) & set(RESERVED)
        else light.name
        for j, light in enumerate(scene.lights)
    ]


def light_part(lights: list[str], row: np.void) -> str:
    """The last part of the name of a shadow ray. `lights` are the `light_names`."""
    return f"{LETTERS['shadow']}({lights[row['light']]})"


def path(nodes: np.ndarray, lights: list[str], i: int) -> str:
    """The path of row `i` of a table of rays (`tracer.nodes`). `lights` are the `light_names`."""
    if nodes["kind"][i] == SHADOW:
        return f"{path(nodes, lights, int(nodes['parent'][i]))}.{light_part(lights, nodes[i])}"
    letters = []
    while nodes["parent"][i] >= 0:
        letters.append(LETTERS[KINDS[nodes["kind"][i]]])
        i = int(nodes["parent"][i])
    return "".join(reversed(letters)) or LETTERS["camera"]


def kind_of(path: str) -> str | None:
    """The kind of the ray with this path, whether or not a tree has it; None if no path ends like this."""
    last = LETTERS["shadow"] if "." in path else re.sub(r"\[\d+\]$", "", path)[-1:]
    return next((kind for kind, letter in LETTERS.items() if letter == last), None)


def numbers(nodes: np.ndarray) -> np.ndarray:
    """The number in the label of each row (n,): how many rays other than shadow rays come before it."""
    return np.cumsum(nodes["kind"] != SHADOW) - 1


def label(nodes: np.ndarray, counted: np.ndarray, lights: list[str], i: int) -> str:
    """The label of row `i`. `counted` are the `numbers`, and `lights` the `light_names`."""
    row = nodes[i]
    if row["kind"] == SHADOW:
        return f"{label(nodes, counted, lights, int(row['parent']))}.{light_part(lights, row)}"
    symbol = SYMBOLS[KINDS[row["kind"]]]
    return f"{symbol}{counted[i]}" if row["parent"] >= 0 else symbol
