"""Opens .blend, .glb and .gltf files of others, renders each small by Relief, and prints what was not taken over.

usage: open_files.py FILE... [--cycles]   with --cycles the same by Cycles, for a comparison of both pictures"""
import pathlib
import sys
import tempfile

import support

import bpy
import numpy as np
import relief_blender
from relief_blender import statistics


def open_file(file):
    if file.suffix == ".blend":
        bpy.ops.wm.open_mainfile(filepath=str(file))
        return
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(file))
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    support.set_world(scene.world, (1, 1, 1))
    support.add_camera((3, -4, 3), (0, 0, 0))


def render(engine, name):
    """(height, width, 4) of a small picture."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 240, 180, 100
    scene.cycles.samples = scene.relief.samples = 16
    scene.use_nodes = scene.render.use_sequencer = False
    support.write_layers(scene, (support.KEEP or pathlib.Path(tempfile.mkdtemp())) / f"{name}_{engine.lower()}.exr")
    bpy.ops.render.render(write_still=True)
    return support.Layers(scene.render.filepath)["Combined"]


def main():
    relief_blender.register()
    files = [pathlib.Path(name).resolve() for name in sys.argv[1:] if name.endswith((".blend", ".glb", ".gltf"))]
    for file in files:
        open_file(file)
        ours = render("RELIEF", file.stem)
        print(f"{file.name}: {len(bpy.data.objects)} objects, mean brightness {ours[..., :3].mean():.4f}")
        if "--cycles" in sys.argv:
            theirs = render("CYCLES", file.stem)
            print(f"  by Cycles {theirs[..., :3].mean():.4f}, mean difference {np.abs(ours - theirs)[..., :3].mean():.4f}")
        for line in statistics.find(bpy.context.scene).lines:
            print(f"  {line}")
    relief_blender.unregister()


if __name__ == "__main__":
    main()
