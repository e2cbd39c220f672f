"""Texels of a map: which triangle is under each, what corners give there, and a margin around the islands."""
import numpy as np

CHUNK = 1 << 22  # candidate texels that are looked at together


class Raster:
    """Texels whose middles are inside of triangles: flat texel indices, triangles, barycentric weights (N, 3)."""

    def __init__(self, uvs, width, height):
        """uvs: (triangles, 3, 2), row 0 of the map is v = 1. Of triangles that overlap the first one counts; `overlap` is the
        share of the texels that are well inside of several."""
        self.width, self.height = width, height
        uvs = np.asarray(uvs, np.float64)
        is_finite = np.isfinite(uvs).all((1, 2), keepdims=True)
        at = np.stack([uvs[..., 0] * width - 0.5, (1 - uvs[..., 1]) * height - 0.5], -1)
        at = np.where(is_finite, at, 0)  # no area: no texels
        found = [self._fill(at, *chunk) for chunk in self._split(*self._find_bands(at))]
        found.append((np.zeros(0, int), np.zeros(0, int), np.zeros((0, 3))))
        texels, triangles, weights = (np.concatenate(part) for part in zip(*found))
        self.texels, first = np.unique(texels, return_index=True)
        self.triangles, self.weights = triangles[first], weights[first]
        is_inner = weights.min(-1, initial=1) > 1e-3
        again = np.unique(texels[is_inner], return_counts=True)[1] > 1
        self.overlap = np.count_nonzero(again) / max(len(self.texels), 1)

    def _find_bands(self, at):
        """(triangles, low, high): boxes of texels around triangles, those of large ones cut into bands of rows."""
        limit = np.array([self.width, self.height])
        low = np.clip(np.ceil(at.min(1) - 1e-6), 0, limit).astype(int)
        high = np.clip(np.floor(at.max(1) + 1e-6) + 1, 0, limit).astype(int)
        size = np.maximum(high - low, 0)
        rows = np.maximum(CHUNK // np.maximum(size[:, 0], 1), 1)
        counts = np.where(size[:, 0] > 0, -(-size[:, 1] // rows), 0)
        triangles = np.repeat(np.arange(len(at)), counts)
        band = np.arange(len(triangles)) - np.repeat(np.cumsum(counts) - counts, counts)
        first = low[triangles, 1] + band * rows[triangles]
        last = np.minimum(first + rows[triangles], high[triangles, 1])
        return triangles, np.stack([low[triangles, 0], first], -1), np.stack([high[triangles, 0], last], -1)

    @staticmethod
    def _split(triangles, low, high):
        """Parts of bands of about CHUNK candidates."""
        total = np.cumsum(np.prod(high - low, -1))
        cuts = np.unique(np.searchsorted(total, np.arange(CHUNK, total[-1], CHUNK))) if len(total) else []
        return [part for part in zip(*(np.split(array, cuts) for array in (triangles, low, high))) if len(part[0])]

    def _fill(self, at, owners, low, high):
        size = high - low
        counts = np.prod(size, -1)
        triangle = np.repeat(owners, counts)
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        across = np.repeat(size[:, 0], counts)
        x = np.repeat(low[:, 0], counts) + within % across
        y = np.repeat(low[:, 1], counts) + within // across
        a, b, c = (at[triangle, k] for k in range(3))
        area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        safe = np.where(area == 0, 1, area)
        w1 = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (y - a[:, 1]) * (c[:, 0] - a[:, 0])) / safe
        w2 = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (x - a[:, 0])) / safe
        weights = np.stack([1 - w1 - w2, w1, w2], -1)
        inside = (area != 0) & np.all(weights >= -1e-6, -1)
        return (y * self.width + x)[inside], triangle[inside], weights[inside]

    def interpolate(self, values):
        """values: (triangles, 3, channels) -> (texels, channels)."""
        return np.einsum("nk,nkc->nc", self.weights, values[self.triangles])

    def make_image(self, values):
        """((height, width, channels) float32, mask of what is inside)."""
        image = np.zeros((self.height * self.width, values.shape[-1]), np.float32)
        mask = np.zeros(self.height * self.width, bool)
        image[self.texels], mask[self.texels] = values, True
        return image.reshape(self.height, self.width, -1), mask.reshape(self.height, self.width)


def add_margin(image, mask, texels):
    """Values of the nearest texels inside, so many texels outwards."""
    image, mask = image.copy(), mask.copy()
    for _ in range(texels):
        total, count = np.zeros_like(image), np.zeros(mask.shape, np.float32)
        for shift in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            source = tuple(slice(max(-s, 0), n - max(s, 0)) for s, n in zip(shift, mask.shape))
            target = tuple(slice(max(s, 0), n - max(-s, 0)) for s, n in zip(shift, mask.shape))
            total[target] += image[source] * mask[source][..., None]
            count[target] += mask[source]
        new = ~mask & (count > 0)
        image[new] = total[new] / count[new][:, None]
        mask |= new
    return image
