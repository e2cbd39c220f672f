"""Structures and traversals beside each other, with the same rays. python compare_structures.py"""
import numpy as np
import relief

random = np.random.default_rng(1)
heights = random.random((64, 64)).astype(np.float32) * 0.05
corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
uvs = np.tile(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32), (6, 1))
cube = relief.Mesh(corners, quads, uvs, subdivision={"scheme": "catmark", "level": 4})
scene = relief.Scene.from_mesh(cube, relief.Displacement(heights, type="height", midlevel=0))

rays = np.zeros((50000, 8), np.float32)
rays[:, 0:3] = random.normal(size=(50000, 3))
rays[:, 0:3] *= 3 / np.linalg.norm(rays[:, 0:3], axis=1, keepdims=True)
rays[:, 4:7] = random.uniform(-0.8, 0.8, (50000, 3)) - rays[:, 0:3]
rays[:, 7] = np.inf

print(f"{'structure':<10} {'traversal':<14} {'Mrays/s':>8} {'same hits':>10}")
for row in relief.trees.compare(scene, rays, level=3):
    print(f"{row['structure']:<10} {row['traversal']:<14} {1e-6 * row['rays_per_second']:8.2f} {row['same_hits']:10.4%}")
