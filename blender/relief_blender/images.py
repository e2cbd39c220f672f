"""Images of Blender as files or as arrays with row 0 at the top, linear Rec.709 unless they are data."""
import os

import bpy
import numpy as np

from .exr_header import is_plain_exr
from .node_tree import NotExpressible

DATA_SPACES = {"Non-Color", "Raw", "Generic Data"}
LINEAR_SPACES = DATA_SPACES | {"Linear Rec.709", "Linear", "scene_linear"}


def decode_srgb(values):
    """The curve of sRGB, as of IEC 61966-2-1."""
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4).astype(np.float32)


def is_data(image):
    return image.colorspace_settings.is_data or image.colorspace_settings.name in DATA_SPACES


def find_file(image):
    """The file of an image that Relief reads with the same values itself, or None. Tiles keep <UDIM>."""
    is_packed = image.packed_file is not None or len(image.packed_files) > 0
    if image.source not in {"FILE", "TILED"} or is_packed or image.is_dirty:
        return None
    if image.colorspace_settings.name not in LINEAR_SPACES:
        return None
    path = bpy.path.abspath(image.filepath, library=image.library)
    first = path.replace("<UDIM>", str(image.tiles[0].number)) if image.source == "TILED" else path
    return os.path.abspath(path) if is_plain_exr(first) else None


def _read_pixels(image, report):
    width, height = image.size
    if width * height == 0:
        raise NotExpressible(f'image "{image.name}" has no pixels: {image.filepath or "no file"}')
    texels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(texels)
    texels = texels.reshape(height, width, image.channels)[::-1]
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = texels[..., :3] if image.channels >= 3 else texels[..., :1]
    if image.channels in (2, 4):
        rgba[..., 3] = texels[..., -1]
    if not image.is_float and not is_data(image):
        if image.colorspace_settings.name not in LINEAR_SPACES:
            rgba[..., :3] = decode_srgb(rgba[..., :3])
        if image.colorspace_settings.name not in LINEAR_SPACES | {"sRGB"}:
            report(f'colour space "{image.colorspace_settings.name}" of image "{image.name}" is taken as sRGB')
    return rgba


def _read_tile(image, number, report):
    """One tile of a tiled image: from its file, as Blender shows scripts the first one alone."""
    path = bpy.path.abspath(image.filepath, library=image.library).replace("<UDIM>", str(number))
    if not os.path.isfile(path):
        return None
    tile = bpy.data.images.load(path, check_existing=False)
    try:
        tile.colorspace_settings.name = image.colorspace_settings.name
        return _read_pixels(tile, report)
    finally:
        bpy.data.images.remove(tile)


def read_tiles(image, report):
    """{1001: (height, width, 4) float32, ...}. `report` takes a text."""
    if image.source == "MOVIE":
        raise NotExpressible(f'image "{image.name}" is a movie')
    if image.source == "SEQUENCE":
        report(f'image "{image.name}" is a sequence: one picture of it is used')
    if image.source != "TILED":
        return {1001: _read_pixels(image, report)}
    numbers = [tile.number for tile in image.tiles]
    tiles = {number: _read_tile(image, number, report) for number in numbers[1:]}
    tiles[numbers[0]] = _read_pixels(image, report)
    missing = [str(number) for number, texels in tiles.items() if texels is None]
    if missing:
        report(f'tiles {" ".join(missing)} of image "{image.name}" are not on disk: save the image')
    return {number: texels for number, texels in tiles.items() if texels is not None}


def make_image(name, texels, are_data=True):
    """A packed float image of (height, width, 3) values, row 0 at the top."""
    height, width = texels.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=True, is_data=are_data)
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = texels
    image.pixels.foreach_set(rgba[::-1].reshape(-1))
    image.update()
    image.pack()
    return image
