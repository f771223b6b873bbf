"""A small lesson with everything that a handout shows: reveals, a sweep, live pieces, notes, formulas, hidden parts."""

from pathlib import Path

EVIL = "<script>evil=1</script><img src=x onerror=evil=2>\"'&amp;</style>--></svg>"

SCENE = """
format = 1
[camera]
position = [0, 1, 6]
look_at = [0, 0.2, 0]
[image]
width = 64
height = 48
[tracing]
depth = 2
[background]
color = [0.4, 0.5, 0.6]
[[light]]
name = "lamp"
position = [4, 6, 5]
color = [0.8, 0.8, 0.8]
[[material]]
name = "glass"
diffuse = 0.1
reflect = 0.1
transmit = 0.8
ior = 1.5
[[material]]
name = "stone"
diffuse = 0.7
[[object]]
name = EVIL
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "glass"
[[object]]
name = "floor"
shape = "plane"
point = [0, -1, 0]
normal = [0, 1, 0]
material = "stone"
"""

LESSON = """+++
title = "Glass EVIL"
question = "Where does it go?"
objectives = ["Follow a ray"]
pixel = [30, 18]
+++
## Ray by ray

```step
reveal = "rays"
hit = "T"
```

The [ray inside](#T) is {t} long, in **glass** with $n_1 = 1.5$. Where does it go?

???

The answer is {TT.object}.

```notes
Say *nothing* yet.
```

## Levels

```step
reveal = "depth"
panels = ["tree", "image"]
```

Each press adds one.

## Snell

```step
hit = "E"
panels = ["hit"]
sweep = { of = "pixel", from = [30, 18], to = [36, 21] }
```

$$n_1 \\sin\\theta_1 = n_2 \\sin\\theta_2$$

| a | b |
|---|---|
| 1 | 2 |

1. one
2. two

```live
snell
```

???

```live
lifeguard
```

## Numbers

```step
hit = "E"
panels = ["ray"]
goal = { theta1 = "12" }
```

These are its numbers.

```source tracer.optics.critical_angle
```

```live
difference
```
"""


def write_lesson(folder: Path) -> Path:
    """The lesson's folder."""
    folder.mkdir()
    name = EVIL.replace("\\", "\\\\").replace('"', '\\"')
    (folder / "scene.toml").write_text(SCENE.replace("EVIL", f'"{name}"'), "utf-8")
    (folder / "lesson.md").write_text(LESSON.replace("EVIL", name), "utf-8")
    return folder
