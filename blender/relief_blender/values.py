"""What a socket gives: one constant, or texels of an image at a place of a uv map, times a factor."""
from dataclasses import dataclass, field, replace

import numpy as np

from . import images
from .node_tree import NotExpressible

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  # Rec.709


@dataclass(frozen=True)
class Place:
    """How an image lies on a mesh: read at scale uv + offset of a uv map ("" is the one that renders)."""
    uv_map: str = ""
    scale: tuple = (1.0, 1.0)
    offset: tuple = (0.0, 0.0)
    wrap: str = "repeat"
    filter: str = "none"


@dataclass(frozen=True)
class Constant:
    """Three channels; a number is three equal ones."""
    rgb: np.ndarray

    @property
    def number(self):
        return float(self.rgb @ LUMINANCE) if np.ptp(self.rgb) > 0 else float(self.rgb[0])


@dataclass(frozen=True)
class Textured:
    """`channel` is "" (colour), r, g, b, a or luminance. Without `tiles` the texels are the image's own."""
    place: Place
    image: object = None
    channel: str = ""
    factor: np.ndarray = field(default_factory=lambda: np.ones(3, np.float32))
    tiles: dict = None


def make_constant(value):
    array = np.atleast_1d(np.asarray(value, np.float32))
    return Constant(array[:3].copy() if array.size >= 3 else np.full(3, array[0], np.float32))


def repeat_number(texels):
    """A read-only view (height, width, 3) of one channel (height, width, 1): a number has three equal channels."""
    return np.broadcast_to(texels, (*texels.shape[:2], 3))


def is_number(array):
    """Whether texels are a view of one channel, or a constant has three equal channels."""
    return array.strides[-1] == 0 if array.ndim == 3 else array.min() == array.max()


def pick_channel(rgba, channel):
    """(height, width, 3) of the (height, width, 4) texels of an image."""
    if not channel:
        return rgba[..., :3]
    one = rgba[..., :3] @ LUMINANCE if channel == "luminance" else rgba[..., "rgba".index(channel)]
    return repeat_number(one[..., None])


class Texels:
    """Texels of values; images are read once. `tiles`: an images.TileCache, or None."""

    def __init__(self, report, tiles=None):
        self._report, self._tiles = report, tiles
        self._read = {}
        self._images = []

    def has_dirty_images(self):
        """Whether one of the images that were read has changes that are in no file."""
        return any(image.is_dirty for image in self._images)

    def read(self, image):
        key = image.name_full
        if key not in self._read:
            self._images.append(image)
            self._read[key] = images.read_tiles(image, self._report, self._tiles)
        return self._read[key]

    def check(self, image):
        """Raises images.MissingImage where there is nothing to read."""
        file = images.find_file(image)
        if file is None:
            self.read(image)
        else:
            images.check_file(image, file)

    def tiles(self, value):
        """{udim: (height, width, 3) float32}, factor included."""
        if isinstance(value, Constant):
            return {1001: value.rgb.reshape(1, 1, 3)}
        source = value.tiles or {n: pick_channel(t, value.channel) for n, t in self.read(value.image).items()}
        if np.all(value.factor == 1):
            return source
        if is_number(value.factor):
            return {number: repeat_number(texels[..., :1] * value.factor[0]) if is_number(texels) else texels * value.factor[0]
                    for number, texels in source.items()}
        return {number: texels * value.factor for number, texels in source.items()}


def resample(texels, height, width):
    """Bilinear, from centre to centre; the size of two images that are computed with each other must agree."""
    if texels.shape[:2] == (height, width) or texels.shape[:2] == (1, 1):
        return texels
    rows = np.clip((np.arange(height) + 0.5) * texels.shape[0] / height - 0.5, 0, texels.shape[0] - 1)
    columns = np.clip((np.arange(width) + 0.5) * texels.shape[1] / width - 0.5, 0, texels.shape[1] - 1)
    r0, c0 = np.floor(rows).astype(int), np.floor(columns).astype(int)
    r1, c1 = np.minimum(r0 + 1, texels.shape[0] - 1), np.minimum(c0 + 1, texels.shape[1] - 1)
    fr, fc = (rows - r0)[:, None, None], (columns - c0)[None, :, None]
    top = texels[r0][:, c0] * (1 - fc) + texels[r0][:, c1] * fc
    bottom = texels[r1][:, c0] * (1 - fc) + texels[r1][:, c1] * fc
    return (top * (1 - fr) + bottom * fr).astype(np.float32)


def common_place(values):
    """The place of all textures among some values."""
    textured = [value for value in values if isinstance(value, Textured)]
    places = {(v.place.uv_map, v.place.scale, v.place.offset, v.place.wrap) for v in textured}
    if len(places) > 1:
        raise NotExpressible("textures of different places are computed with each other")
    return textured[0].place


def combine(function, values, texels, by_channel=False):
    """function(*arrays of (..., 3)) of values, as one value: a constant, or a new texture. `by_channel`: each channel of the
    result depends on that of the arguments alone, so that numbers are computed once."""
    if all(isinstance(value, Constant) for value in values):
        return Constant(np.asarray(function(*(v.rgb for v in values)), np.float32))
    place = common_place(values)
    tiles = [texels.tiles(value) if isinstance(value, Textured) else value.rgb for value in values]
    numbers = set.intersection(*(set(t) for t in tiles if isinstance(t, dict)))
    result = {}
    for number in sorted(numbers):
        parts = [t[number] if isinstance(t, dict) else t for t in tiles]
        height = max(p.shape[0] for p in parts if p.ndim == 3)
        width = max(p.shape[1] for p in parts if p.ndim == 3)
        parts = [resample(p, height, width) if p.ndim == 3 else p for p in parts]
        if by_channel and all(is_number(p) for p in parts):
            one = function(*(p[..., :1] for p in parts))
            result[number] = repeat_number(np.ascontiguousarray(np.broadcast_to(one, (height, width, 1)), np.float32))
        else:
            result[number] = np.ascontiguousarray(np.broadcast_to(function(*parts), (height, width, 3)), np.float32)
    return Textured(place, tiles=result)


def multiply(a, b, texels):
    """a b; a texture times a constant keeps its image."""
    if isinstance(a, Constant) and isinstance(b, Textured):
        a, b = b, a
    if isinstance(a, Textured) and isinstance(b, Constant):
        return replace(a, factor=a.factor * b.rgb)
    return combine(np.multiply, [a, b], texels, by_channel=True)


def to_number(value, texels):
    """A colour where a number is wanted is its luminance."""
    if isinstance(value, Constant):
        return make_constant(value.number)
    if value.channel and np.ptp(value.factor) == 0:
        return value
    if value.tiles is None and not value.channel and np.all(value.factor == 1):
        return replace(value, channel="luminance")
    if value.tiles and np.ptp(value.factor) == 0 and all(is_number(t) for t in value.tiles.values()):
        return value
    return combine(lambda rgb: np.repeat((rgb @ LUMINANCE)[..., None], 3, -1), [value], texels)


def select_channel(value, index, texels):
    """One channel of a colour, as a number."""
    if isinstance(value, Constant):
        return make_constant(value.rgb[index])
    if value.tiles is None and not value.channel:
        return replace(value, channel="rgb"[index], factor=np.full(3, value.factor[index], np.float32))
    return combine(lambda rgb: np.repeat(rgb[..., index:index + 1], 3, -1), [value], texels)
