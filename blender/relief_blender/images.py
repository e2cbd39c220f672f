"""Images of Blender as files or as arrays with row 0 at the top, linear Rec.709 unless they are data."""
import hashlib
import os
from typing import NamedTuple

import bpy
import numpy as np
import relief

from .exr_header import is_plain_exr
from .node_tree import NotExpressible

EXR_MAGIC = b"\x76\x2f\x31\x01"
DATA_SPACES = {"Non-Color", "Raw", "Generic Data"}
LINEAR_SPACES = DATA_SPACES | {"Linear Rec.709", "Linear", "scene_linear"}


def decode_srgb(values):
    """The curve of sRGB, as of IEC 61966-2-1."""
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4).astype(np.float32)


def is_data(image):
    return image.colorspace_settings.is_data or image.colorspace_settings.name in DATA_SPACES


def find_file(image):
    """The file of an image that Relief reads with the same values itself, or None. Tiles keep <UDIM>. One that is packed is
    written to Blender's temporary folder: that costs less memory than its texels, which Blender need not read then."""
    if image.source not in {"FILE", "TILED"} or image.is_dirty or image.colorspace_settings.name not in LINEAR_SPACES:
        return None
    if len(image.packed_files) > 0:
        return _unpack(image) if image.source == "FILE" and len(image.packed_files) == 1 else None
    path = bpy.path.abspath(image.filepath, library=image.library)
    if "##" in path or image.source == "FILE" and any(sign in path.lower() for sign in ("<udim>", "<uvtile>")):
        return None  # Relief would put the number of a frame or of a tile in its place
    first = path.replace("<UDIM>", str(image.tiles[0].number)) if image.source == "TILED" else path
    return os.path.abspath(path) if is_plain_exr(first) else None


def _unpack(image):
    """A file with what is packed into an image, or None. Its name is that of its content, so that it is written once."""
    data = image.packed_file.data
    if not data.startswith(EXR_MAGIC):
        return None
    name = hashlib.blake2b(data, digest_size=16).hexdigest()
    path = os.path.join(bpy.app.tempdir, f"relief-{name}.exr")
    if not os.path.exists(path):
        with open(f"{path}.part", "wb") as file:
            file.write(data)
        os.replace(f"{path}.part", path)
    return path if is_plain_exr(path) else None


class MissingImage(NotExpressible):
    """An image of which no texel can be read."""

    def tell(self, instead):
        """The line of a report. `instead`: what becomes of the thing."""
        return f"{self}: {instead} (File > External Data > Find Missing Files)"


class DamagedImage(MissingImage):
    """An image whose texels cannot be used."""

    def tell(self, instead):
        return f"{self}: {instead}"


_faults = {}  # of files that Relief reads itself, by path, time and size: why it cannot, or ""


def _find_fault(path):
    """Why Relief cannot use the texels of a file, or ""."""
    state = os.stat(path)
    key = path, state.st_mtime_ns, state.st_size
    if key not in _faults:
        try:
            _faults[key] = _describe_bad_texel(_load_colors(path))
        except relief.Error as fault:
            _faults[key] = fault.message
    return _faults[key]


def _load_colors(path):
    """(height, width, channels) of a file as Relief reads it, without alpha."""
    picture = relief.Picture.load(path)
    return picture.array[..., [k for k, name in enumerate(picture.channels) if name != "A"]]


def _describe_bad_texel(colors):
    """Where the first texel is that is not finite, or ""."""
    if np.isfinite(np.sum(colors, dtype=np.float64)):  # the usual case, fast
        return ""
    bad = ~np.all(np.isfinite(colors), -1)
    if not bad.any():
        return ""
    row, column = np.unravel_index(np.argmax(bad), bad.shape)
    kind = "NaN" if np.isnan(colors[row, column]).any() else "infinity"
    return f"{np.count_nonzero(bad)} of its texels are not finite, the first is {kind} at column {column}, row {row} from the top"


def check_file(image, path):
    """Raises DamagedImage for a file of an image that Relief cannot use."""
    numbers = [tile.number for tile in image.tiles] if "<UDIM>" in path else [None]
    for number in numbers:
        file = path if number is None else path.replace("<UDIM>", str(number))
        fault = _find_fault(file) if os.path.isfile(file) else ""
        if fault:
            tile = "" if number is None else f", tile {number}"
            raise DamagedImage(f'image "{image.name}"{tile} cannot be used: {fault}: {file}')


class Pixels(NamedTuple):
    """An image as Blender has it: rows from the bottom, in the colour space of its file where it has bytes."""
    texels: np.ndarray  # (height, width, channels), float32 or uint8
    is_data: bool
    color_space: str


class TileCache:
    """Tiles as they were last read. Each reading makes and removes an image of the file that is open, which Blender takes for
    a change of the scene: a viewport that read its tiles anew at each change would begin anew for ever."""

    def __init__(self):
        self._kept, self._used = {}, set()

    def read(self, path, image):
        """The Pixels of a file, read with the settings of an image. None: it is no image."""
        state = os.stat(path)
        key = path, state.st_mtime_ns, state.st_size, image.colorspace_settings.name, image.alpha_mode
        self._used.add(key)
        if key not in self._kept:
            self._kept[key] = _load_tile(path, image)
        return self._kept[key]

    def forget_unused(self):
        """Keeps what was read since the last call."""
        self._kept = {key: pixels for key, pixels in self._kept.items() if key in self._used}
        self._used = set()


def _fetch(image):
    """The Pixels of an image, or None."""
    width, height = image.size
    if width * height == 0:
        return None
    texels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(texels)
    if not image.is_float:
        np.multiply(texels, 255, out=texels)
        texels = np.rint(texels, out=texels).astype(np.uint8)
    return Pixels(texels.reshape(height, width, image.channels), is_data(image), image.colorspace_settings.name)


def _load_tile(path, image):
    """From its own file, as Blender shows scripts the first tile alone."""
    try:
        tile = bpy.data.images.load(path, check_existing=False)
    except RuntimeError:
        return None
    try:
        if image.colorspace_settings.name:  # else its own, as of an image of which nothing could be read yet
            tile.colorspace_settings.name = image.colorspace_settings.name
        tile.alpha_mode = image.alpha_mode
        return _fetch(tile)
    finally:
        bpy.data.images.remove(tile)


def _decode(pixels, name, report):
    """(height, width, 4) float32, row 0 at the top, linear unless they are data."""
    height, width, channels = pixels.texels.shape
    texels = pixels.texels[::-1]
    is_float = texels.dtype != np.uint8
    if is_float and channels == 4:
        return texels
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = texels[..., :3] if channels >= 3 else texels[..., :1]
    if channels in (2, 4):
        rgba[..., 3] = texels[..., -1]
    if is_float:
        return rgba
    rgba[..., :3 if channels in (1, 3) else 4] *= np.float32(1 / 255)
    if not pixels.is_data and pixels.color_space not in LINEAR_SPACES:
        rgba[..., :3] = decode_srgb(rgba[..., :3])
        if pixels.color_space != "sRGB":
            report(f'colour space "{pixels.color_space}" of image "{name}" is taken as sRGB')
    return rgba


def _fetch_tiles(image, cache):
    """{udim: Pixels or None} of a tiled image."""
    pattern = bpy.path.abspath(image.filepath, library=image.library)
    numbers = [tile.number for tile in image.tiles]
    first = _fetch(image)  # before the others: an image has no colour space until Blender has read it
    paths = {number: pattern.replace("<UDIM>", str(number)) for number in numbers[1:]}
    result = {number: cache.read(path, image) if os.path.isfile(path) else None for number, path in paths.items()}
    return {numbers[0]: first, **result}


def read_tiles(image, report, cache=None):
    """{1001: (height, width, 4) float32, ...}. `report` takes a text. `cache`: a TileCache."""
    if image.source == "MOVIE":
        raise NotExpressible(f'image "{image.name}" is a movie')
    if image.source == "SEQUENCE":
        report(f'image "{image.name}" is a sequence: one picture of it is used')
    fetched = _fetch_tiles(image, cache or TileCache()) if image.source == "TILED" else {1001: _fetch(image)}
    tiles = {number: _decode(pixels, image.name, report) for number, pixels in fetched.items() if pixels is not None}
    if not tiles:
        raise MissingImage(f'image "{image.name}" has no pixels: {image.filepath or "no file"}')
    for number, texels in tiles.items():
        fault = _describe_bad_texel(texels[..., :3])
        if fault:
            raise DamagedImage(f'image "{image.name}"{"" if len(tiles) == 1 else f", tile {number}"} cannot be used: {fault}')
    missing = [str(number) for number in fetched if number not in tiles]
    if missing:
        report(f'tiles {" ".join(missing)} of image "{image.name}" are not on disk: save the image')
    return tiles


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
