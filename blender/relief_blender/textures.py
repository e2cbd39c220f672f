"""Values as numbers, colours and texture objects of a material in Relief."""
import numpy as np

from . import images
from .values import Constant, Place

LARGEST = 3e38  # number that Relief takes; Blender has 3.4e38 for infinity


class TextureWriter:
    """Makes the values of keys. `base` is the place of the mesh's own uvs: see MaterialExport. `further`: the uv maps of
    textures that lie on others, whose uv sets are 1, 2 and so on."""

    def __init__(self, texels, report, base):
        self._texels, self._report, self._base = texels, report, base
        self.further = []

    def color(self, value, label, least=0.0, most=1.0):
        if isinstance(value, Constant):
            return [float(v) for v in self._limit(value.rgb, label, least, most)]
        return self._texture(value, label, most, is_number=False)

    def number(self, value, label, least=0.0, most=1.0):
        if isinstance(value, Constant):
            return float(self._limit(np.array([value.number]), label, least, most)[0])
        return self._texture(value, label, most, is_number=True)

    def normal(self, value, scale):
        keys = self._place(value, "normal map", has_own_set=False)
        keys["file"] = self._file(value, np.ones(3)) or self._arrays(value, is_number=False)
        keys["scale"] = float(self._limit(np.array([scale]), "strength of the normal map", 0.0, 1000.0)[0])
        return keys

    def mean(self, value):
        """The mean of a texture's texels, as a constant."""
        means = [t.reshape(-1, 3).mean(0) for t in self._texels.tiles(value).values()]
        return Constant(np.mean(means, 0).astype(np.float32))

    def _limit(self, array, label, least, most):
        limited = np.clip(array, least, most)
        is_finite = np.abs(limited) < LARGEST
        if not np.all(is_finite):
            self._report(f"{label} is not finite: {least:g} is used")
            return np.where(is_finite, limited, least)
        if np.any(np.abs(limited - array) > 1e-6):
            self._report(f"{label} {np.round(array, 3).tolist()} is limited to [{least:g}, {most:g}]")
        return limited

    def _texture(self, value, label, most, is_number):
        keys = self._place(value, label)
        keys["file"] = self._file(value, value.factor)
        if keys["file"] is not None and np.all(value.factor >= 0) and np.all(value.factor <= min(most, LARGEST)):
            factor = value.factor.tolist()
            keys["factor"] = float(value.factor[0]) if is_number or len(set(factor)) == 1 else factor
            channel = value.channel or ("luminance" if is_number else "")
            keys.update({"channel": channel} if channel else {})
        else:
            keys["file"] = self._arrays(value, is_number, most)
        return keys

    def _file(self, value, factor):
        """The image's own file, where Relief reads the same from it."""
        if value.tiles is not None or value.image is None or np.any(factor < 0):
            return None
        return images.find_file(value.image)

    def _arrays(self, value, is_number, most=np.inf):
        tiles = self._texels.tiles(value)
        if not all(np.all(np.isfinite(t)) for t in tiles.values()):
            self._report("texels that are not finite after a computation are 0")
            tiles = {n: np.nan_to_num(t, nan=0.0, posinf=0.0, neginf=0.0) for n, t in tiles.items()}
        tiles = {n: np.ascontiguousarray(np.clip(t[..., :1] if is_number else t, -np.inf, most), np.float32)
                 for n, t in tiles.items()}
        return tiles if list(tiles) != [1001] else tiles[1001]

    def _place(self, value, label, has_own_set=True):
        place, base = value.place, self._base
        keys = {}
        if place.uv_map != base.uv_map and has_own_set:
            if place.uv_map not in self.further:
                self.further.append(place.uv_map)
            keys["uv_set"] = self.further.index(place.uv_map) + 1
            base = Place()  # further sets are as the mesh of Blender has them
        elif place.uv_map != base.uv_map:
            self._report(f'{label} lies on the uv map "{place.uv_map or "that renders"}": '
                         f'"{base.uv_map or "that renders"}" is used')
        scale = [p / b for p, b in zip(place.scale, base.scale)]
        offset = [o - s * b for o, s, b in zip(place.offset, scale, base.offset)]
        if scale != [1.0, 1.0]:
            keys["uv_scale"] = scale
        if offset != [0.0, 0.0]:
            keys["uv_offset"] = offset
        if place.filter != "none":
            keys["filter"] = place.filter
        is_tiled = value.image is not None and value.image.source == "TILED" or value.tiles and list(value.tiles) != [1001]
        if not is_tiled and place.wrap != "repeat":
            keys["wrap"] = place.wrap
        return keys
