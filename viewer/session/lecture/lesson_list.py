"""The lessons of the menu, with a picture each: rendered when the menu is first opened, then kept on disk."""

import hashlib
import io
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import tracer
from tracer.compile.kernel_cache import cache_folder, make_private
from tracer.printable import printable
from viewer.base.files import Unusable, write_atomically
from viewer.base.pictures import png
from viewer.base.srgb import srgb
from viewer.lessons import lesson as lessons
from viewer.session.image_renderer import lower_priority
from viewer.session.loading.file_watch import stamp

SIZE = (88, 66)  # pixels, of a picture
SAMPLES = 4  # of a pixel


@dataclass(frozen=True)
class Entry:
    """A lesson of the program."""

    name: str
    title: str
    is_deeper: bool  # it does not belong to the course


class LessonList:
    """The lessons as they were when the menu was opened. `post` gives a call to the window's thread."""

    def __init__(
        self,
        post: Callable[[Callable[[], object]], object],
        folder: Path | None = None,
        languages: Sequence[str] | None = None,
    ) -> None:
        """`folder` of the pictures: by default that of the kernels. `languages` of the titles: as for `read_title`."""
        self.post, self.languages, self.folder = post, languages, folder
        self.entries: list[Entry] = []
        self.pictures: dict[str, np.ndarray] = {}  # (height, width, 3) 8-bit sRGB, by name
        self.asked: set[str] = set()
        self.runner: ThreadPoolExecutor | None = None  # from the first picture on

    def read(self) -> None:
        """Read the titles again. Called when the menu opens."""
        course = lessons.course()
        self.entries = [Entry(name, _title(name, self.languages), name not in course) for name in lessons.names()]

    def picture(self, name: str) -> np.ndarray | None:
        """The picture of a lesson; None if it is not there yet: then it is made in another thread."""
        if name not in self.asked:
            self.asked.add(name)
            self.runner = self.runner or ThreadPoolExecutor(1, initializer=lower_priority)
            self.runner.submit(self._make, name)
        return self.pictures.get(name)

    def close(self) -> None:
        if self.runner:
            self.runner.shutdown(cancel_futures=True)

    def _make(self, name: str) -> None:
        """Read a picture from the disk, or render it and keep it there. A lesson with faults has none."""
        file = _file(name, self.folder or cache_folder())
        pixels = _stored(file) if file else None
        if pixels is not None:
            self.post(lambda: self.pictures.update({name: pixels}))
            return
        try:
            pixels = _rendered(name)
        except (Unusable, tracer.SceneError):
            return
        if file:
            with suppress(OSError, Unusable):  # it is rendered again next time
                make_private(file.parent)
                write_atomically(file, png(pixels))
        self.post(lambda: self.pictures.update({name: pixels}))


def _title(name: str, languages: Sequence[str] | None) -> str:
    try:
        return printable(lessons.read_title(name, languages))
    except Unusable:
        return name


def _file(name: str, cache: Path | None) -> Path | None:
    """The file of a picture: its name changes when a file of the lesson does."""
    if cache is None:
        return None
    files = sorted((lessons.folder() / name).iterdir())
    about = repr([name, SIZE, SAMPLES, *((path.name, stamp(path)) for path in files)])
    return cache / "thumbnails" / f"{hashlib.sha256(about.encode()).hexdigest()[:24]}.png"


def _stored(file: Path) -> np.ndarray | None:
    """The pixels of a picture on disk; None if it is not there, or damaged."""
    from PIL import Image

    try:
        with Image.open(io.BytesIO(file.read_bytes()), formats=["PNG"]) as picture:
            pixels = np.asarray(picture.convert("RGB"))
    except (OSError, SyntaxError, ValueError):  # which is what damaged files raise
        return None
    return pixels if pixels.shape == (SIZE[1], SIZE[0], 3) else None


def _rendered(name: str) -> np.ndarray:
    """The image of the lesson's first step, which fills the picture and is cut off at two sides."""
    step = lessons.read(name).first
    world = tracer.prepare(tracer.load(step.scene, changes=step.state.set))
    image, (width, height) = world.scene.image, SIZE
    share = max(width / image.width, height / image.height)
    size = (max(width, round(share * image.width)), max(height, round(share * image.height)))
    depth, model = step.state.depth, step.state.model
    pixels = tracer.render(world, size, samples=SAMPLES, depth=depth, threads=1, model=model).pixels
    left, top = (size[0] - width) // 2, (size[1] - height) // 2
    return np.ascontiguousarray(srgb(pixels[top : top + height, left : left + width]))
