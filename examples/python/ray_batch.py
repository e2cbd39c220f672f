"""A batch of rays: heights of a displaced surface, straight from above. With matplotlib, as a plot.

python ray_batch.py [FILE.png]"""
import sys

import numpy as np
import relief

SIDE = 300

u, v = np.meshgrid(np.linspace(0, 1, 256), np.linspace(0, 1, 256))
vectors = np.zeros((256, 256, 3), np.float32)
vectors[:, :, 0] = 0.1 * np.sin(20 * v)
vectors[:, :, 2] = 0.2 * np.cos(15 * u)
plane = relief.Mesh([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], [[0, 1, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
scene = relief.Scene.from_mesh(plane, relief.Displacement(vectors, space="tangent", axes="t,b,n", midlevel=0))

x, z = np.meshgrid(np.linspace(-1.2, 1.2, SIDE), np.linspace(-1.2, 1.2, SIDE))
origins = np.stack([x, np.full_like(x, 2.0), z], axis=-1).reshape(-1, 3)
directions = np.broadcast_to(np.array([0.0, -1.0, 0.0]), origins.shape)
hits = relief.Intersector(scene).closest_hits(origins, directions, attributes=["shading_normal"])
heights = np.where(hits.is_hit, 2.0 - hits.t, np.nan).reshape(SIDE, SIDE)
print(f"{int(hits.is_hit.sum())} of {len(hits)} rays hit, heights from {np.nanmin(heights):.3f} to {np.nanmax(heights):.3f}")

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    print("no plot: matplotlib is not installed")
else:
    figure, axes = pyplot.subplots()
    figure.colorbar(axes.imshow(heights, extent=(-1.2, 1.2, 1.2, -1.2)), label="height, scene units")
    axes.set(xlabel="x", ylabel="z")
    figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "ray_batch.png")
