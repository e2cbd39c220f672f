"""Painting a map: after the first picture, each stroke costs what it changed. python paint_map.py [FILE.png]"""
import sys
import time

import numpy as np
import relief

SIDE, RADIUS, STROKES = 512, 24, 6

heights = np.zeros((SIDE, SIDE), np.float32)
plane = relief.Mesh([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], [[0, 1, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]],
                    subdivision={"scheme": "bilinear", "level": 4})
scene = relief.Scene.from_mesh(plane, relief.Displacement(heights, type="height", midlevel=0))
session = relief.Session(scene, size=(480, 270), spp=8)
session.render()

y, x = np.mgrid[-RADIUS:RADIUS, -RADIUS:RADIUS]
brush = 0.1 * np.exp(-8.0 * (x * x + y * y) / RADIUS**2)
for stroke in range(STROKES):
    angle = 2 * np.pi * stroke / STROKES
    left, top = (int(SIDE / 2 + 0.3 * SIDE * f) - RADIUS for f in (np.cos(angle), np.sin(angle)))
    window = heights[top : top + 2 * RADIUS, left : left + 2 * RADIUS]
    window += brush
    start = time.perf_counter()
    patches = session.edit("displacement", window, x=left, y=top)
    picture = session.render()
    print(f"stroke {stroke}: {patches} patches, next picture after {time.perf_counter() - start:.3f} s")
picture.save(sys.argv[1] if len(sys.argv) > 1 else "paint_map.png")
