"""A first picture: a plane, displaced by an array of heights. python first_picture.py [FILE.png]"""
import sys

import numpy as np
import relief

u, v = np.meshgrid(np.linspace(0, 1, 512), np.linspace(0, 1, 512))
heights = 0.08 * np.sin(40 * np.hypot(u - 0.5, v - 0.5)) * np.exp(-3 * np.hypot(u - 0.5, v - 0.5))
plane = relief.Mesh([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], [[0, 1, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
scene = relief.Scene.from_mesh(plane, relief.Displacement(heights, type="height", midlevel=0),
                               material=relief.Material(base_color=(0.1, 0.3, 0.5), specular_roughness=0.2))
picture = relief.render(scene, size=(640, 360), spp=16)
picture.save(sys.argv[1] if len(sys.argv) > 1 else "first_picture.png")
