"""The rendered image as a texture. Only the tiles that are new are sent to the graphics card."""

import moderngl
import numpy as np

from tracer.image.tiles import Tile
from viewer.session.image_renderer import Picture


class PictureTexture:
    """The texture of one picture, as far as it is rendered. Its first row is the picture's top."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.texture: moderngl.Texture | None = None
        self.state: tuple[Picture | None, int] = (None, 0)  # the picture that was sent, and how many of its tiles

    def update(self, picture: Picture) -> moderngl.Texture:
        """Send what is new of a picture."""
        height, width = picture.shown.shape[:2]
        texture = self.texture
        if texture is None or texture.size != (width, height):
            self.release()
            texture = self.texture = self.ctx.texture((width, height), 4)
            self.state = (None, 0)
        before, count = self.state
        if picture is not before:
            self.state = (picture, len(picture.tiles))  # tiles that are finished meanwhile are sent again
            texture.write(picture.shown)
        elif tiles := picture.tiles[count:]:
            _send(texture, picture.shown, tiles)
            self.state = (picture, count + len(tiles))
        return texture

    def release(self) -> None:
        if self.texture:
            self.texture.release()


def _send(texture: moderngl.Texture, pixels: np.ndarray, tiles: list[Tile]) -> None:
    """Send the rectangle around the tiles, which follow each other by rows. The whole image would take too long."""
    left, top = min(tile.left for tile in tiles), min(tile.top for tile in tiles)
    right, bottom = max(tile.right for tile in tiles), max(tile.bottom for tile in tiles)
    place = (left, top, right - left, bottom - top)
    texture.write(pixels[top:bottom, left:right].tobytes(), viewport=place)
