"""A data set of depth and normals: views of one surface from a circle of cameras. python depth_data_set.py [FILE.npz]"""
import sys

import numpy as np
import relief

VIEWS, SIZE = 8, (160, 120)

corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
uvs = np.tile(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32), (6, 1))
u, v = np.meshgrid(np.linspace(0, 1, 128), np.linspace(0, 1, 128))
bumps = 0.1 * np.sin(2 * np.pi * 4 * u) ** 2 * np.sin(2 * np.pi * 4 * v) ** 2
body = relief.Mesh(corners, quads, uvs, subdivision={"scheme": "catmark", "level": 3})
scene = relief.Scene.from_mesh(body, relief.Displacement(bumps, type="height", midlevel=0))

depths, normals, cameras = [], [], []
for view in range(VIEWS):
    angle = 2 * np.pi * view / VIEWS
    scene.camera = relief.Camera(from_=(4 * np.sin(angle), 1.5, 4 * np.cos(angle)), to=(0, 0, 0), fov_degrees=35)
    picture = relief.render(scene, size=SIZE, spp=4, bounces=0, layers=("depth", "N"), background="transparent")
    depths.append(picture["depth"])
    normals.append(picture["N"])
    cameras.append(scene.camera["from"])
file = sys.argv[1] if len(sys.argv) > 1 else "depth_data_set.npz"
np.savez_compressed(file, depth=np.stack(depths), normal=np.stack(normals), camera=np.array(cameras))
print(f"{VIEWS} views, {np.isfinite(depths).mean():.0%} of the pixels on the body: {file}")
