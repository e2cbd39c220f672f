"""Texels of a map: which triangle is under each, what corners give there, and a margin around the islands."""
import numpy as np

CHUNK = 1 << 22  # candidate texels that are looked at together


class Raster:
    """Texels whose middles are inside of triangles: flat texel indices, triangles, barycentric weights (N, 3)."""

    def __init__(self, uvs, width, height):
        """uvs: (triangles, 3, 2), row 0 of the map is v = 1."""
        self.width, self.height = width, height
        at = np.stack([uvs[..., 0] * width - 0.5, (1 - uvs[..., 1]) * height - 0.5], -1).astype(np.float64)
        limit = np.array([width, height])
        low = np.clip(np.ceil(at.min(1) - 1e-6), 0, limit).astype(int)
        high = np.clip(np.floor(at.max(1) + 1e-6) + 1, 0, limit).astype(int)
        counts = np.prod(np.maximum(high - low, 0), -1)
        found = [self._fill(at, low, high, chosen) for chosen in self._split(counts)]
        texels, triangles, weights = (np.concatenate(part) for part in zip(*found))
        self.texels, first = np.unique(texels, return_index=True)
        self.triangles, self.weights = triangles[first], weights[first]

    @staticmethod
    def _split(counts):
        """Groups of triangles of about CHUNK candidates."""
        groups = np.cumsum(counts) // CHUNK
        return [np.flatnonzero(groups == group) for group in np.unique(groups)]

    def _fill(self, at, low, high, chosen):
        size = np.maximum(high - low, 0)[chosen]
        counts = np.prod(size, -1)
        triangle = np.repeat(chosen, counts)
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        across = np.repeat(size[:, 0], counts)
        x = low[triangle, 0] + within % np.maximum(across, 1)
        y = low[triangle, 1] + within // np.maximum(across, 1)
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
