"""Relief: ray tracing of vector-displaced surfaces. Arrays in, pictures and hits out.

    import numpy as np, relief
    u, v = np.meshgrid(np.linspace(0, 1, 256), np.linspace(0, 1, 256))
    plane = relief.Mesh([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], [[0, 1, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
    scene = relief.Scene.from_mesh(plane, 0.1 * np.sin(20 * u) * np.sin(20 * v))
    relief.render(scene, size=(640, 360), spp=16).save("waves.png")

Scene, Mesh, Displacement, Material, Camera, Light, Environment: what is rendered, with the keys of scene files.
render, Session, LiveScene, Picture: pictures, at once, while maps are painted, or while all of a scene changes.
Intersector, Hits: batches of rays. trees: structures and traversals to compare.
parse_frames, name_frame: shots, frame by frame. Error: what all of these raise.
inspect, convert: what maps and meshes are; maps in other conventions. material_inputs: the keys of materials.

Lengths are scene units, y is up, angles degrees, colours linear Rec.709."""
from . import trees
from ._errors import Error
from ._live import LiveScene
from ._mesh import Mesh
from ._parts import Camera, Displacement, Environment, Light, Material
from ._picture import Picture
from ._rays import NOTHING, Hits, Intersector
from ._relief import Progress
from ._relief import version as __version__
from ._render import Session, render
from ._scene import Scene
from ._tools import convert, devices, inspect, isas, material_inputs, name_frame, parse_frames

__all__ = ["Camera", "Displacement", "Environment", "Error", "Hits", "Intersector", "Light", "LiveScene", "Material", "Mesh", "NOTHING",
           "Picture", "Progress", "Scene", "Session", "__version__", "convert", "devices", "inspect", "isas",
           "material_inputs", "name_frame", "parse_frames", "render", "trees"]
