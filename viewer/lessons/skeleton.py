"""A new lesson: a folder with a text to fill in, and a scene. It passes the check as it is."""

from pathlib import Path

from viewer.base.files import Unusable, write_atomically

TEXT = """\
+++
title = "A mirror ball"
question = "Why does the ball show the floor?"
minutes = 5
objectives = ["Follow a reflected ray from the eye to what the mirror shows"]
+++
## What does this pixel show?

```step
pixel = [160, 150]
hit = "E"
panels = ["scene", "tree"]
expect = { object = "ball", children = ["R"], R.object = "floor" }
```

The marked pixel is on the ball. **Whose colour** do you see there?

???

That of the floor: the [reflected ray](#R) goes there.

## The angle

```step
panels = ["scene", "hit"]
hit = "E"
```

The ray meets the ball at {theta1}, and leaves it at the same angle.

```notes
Click other pixels of the ball. The key Home comes back to this step.
```
"""

SCENE = """\
format = 1
title = "A mirror ball on a floor"

[camera]
position = [0, 1.5, 5]
look_at = [0, 0.8, 0]
fov = 35

[image]
width = 320
height = 240

[background]
color = [0.35, 0.5, 0.75]

[[light]]
name = "lamp"
position = [3, 5, 4]
color = [0.9, 0.9, 0.9]

[[material]]
name = "mirror"
diffuse = 0.1
specular = 0.5
shininess = 60
reflect = 0.8

[[material]]
name = "tiles"
color = [0.9, 0.85, 0.75]
ambient = 0.2
diffuse = 0.8
checker = { color = [0.45, 0.25, 0.2], size = 0.5 }

[[object]]
name = "ball"
shape = "sphere"
center = [0, 0.8, 0]
radius = 0.8
material = "mirror"

[[object]]
name = "floor"
shape = "polygon"
vertices = [[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]]
material = "tiles"
"""

FILES = {"lesson.md": TEXT, "scene.toml": SCENE}


def write_skeleton(folder: Path) -> list[Path]:
    """Write the files of a new lesson, and return their paths. Raises Unusable if the folder is there already."""
    if folder.exists():
        raise Unusable(f"{folder}: is there already: name a new folder")
    try:
        folder.mkdir(parents=True)
    except OSError as error:
        raise Unusable(f"{folder}: cannot be made: {error.strerror or error}") from None
    for name, content in FILES.items():
        write_atomically(folder / name, content.encode("utf-8"))
    return [folder / name for name in FILES]
