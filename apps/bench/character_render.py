"""Renders a scene folder of Relief in Blender with Cycles or with Relief's extension, and prints the measures.

Each line of them is `relief: measure NAME VALUE`. With --session the scene is rendered again in the same process after the
camera has turned, an object has moved and a map has changed. Runs as cycles_scene.py does, which lies beside it:
blender -b --factory-startup --python character_render.py -- OPTIONS; --probe instead of OPTIONS prints what can render.
"""
import math
import os
import sys
import time

import bpy
import addon_utils  # which bpy makes known
from mathutils import Matrix, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import cycles_scene  # noqa: E402
from cycles_scene import tell  # noqa: E402

INSTALLED_EXTENSION = "bl_ext.user_default.relief_blender"


def enable_relief():
    """Empty where the engine RELIEF can be used; else why not. An extension in PYTHONPATH goes before an installed one."""
    try:
        try:
            import relief_blender
            relief_blender.register()
        except ModuleNotFoundError:
            addon_utils.enable(INSTALLED_EXTENSION, handle_error=lambda _: None)
        import relief  # noqa: F401 - the extension asks for it at the first render
    except ImportError as error:
        return str(error)
    return "" if hasattr(bpy.types.Scene, "relief") else "the extension relief_blender is not installed"


def probe():
    tell("blender " + bpy.app.version_string)
    if getattr(bpy.app, "module", False):
        bpy.ops.wm.read_factory_settings()
    reason = enable_relief()
    tell("without RELIEF: " + reason.replace("\n", " ") if reason else "with RELIEF")


def choose_relief(arguments):
    """Settings of the engine RELIEF; those of the scene are made already."""
    scene = bpy.context.scene
    scene.render.engine = "RELIEF"
    scene.relief.samples, scene.relief.bounces, scene.relief.seed = arguments.samples, arguments.bounces, arguments.seed


def render(name):
    start = time.perf_counter()
    bpy.ops.render.render()
    tell(f"measure {name} {time.perf_counter() - start}")


def turn(thing, camera, degrees):
    """The camera goes around the point that it looks at."""
    to = Vector(camera["to"])
    turned = Matrix.Rotation(math.radians(degrees), 3, "Y") @ (Vector(camera["from"]) - to) + to
    cycles_scene.look(thing, dict(camera, **{"from": tuple(turned)}))


def change_map(thing, file):
    tree = thing.material_slots[0].material.node_tree
    node = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeTexImage")
    node.image = cycles_scene.load_image(file)


def run_session(arguments, scene, things, camera):
    turn(camera, scene["camera"], arguments.turn)
    render("turned_s")
    things[0].matrix_world = Matrix.Translation(tuple(map(float, arguments.move.split(",")))) @ things[0].matrix_world
    render("moved_s")
    if arguments.changed_map:
        change_map(things[0], arguments.changed_map)
        render("changed_s")


def main():
    if "--probe" in sys.argv:
        probe()
        return
    parser = cycles_scene.make_parser()
    parser.add_argument("--engine", choices=("CYCLES", "RELIEF"), required=True)
    parser.add_argument("--session", action="store_true")
    parser.add_argument("--turn", type=float, default=0, help="degrees of the camera about what it looks at")
    parser.add_argument("--move", default="0,0,0", help="X,Y,Z of the first object")
    parser.add_argument("--changed-map", help="another map of the first object")
    arguments = parser.parse_args(cycles_scene.list_words())
    scene, things, camera = cycles_scene.build_scene(arguments)
    if arguments.engine == "RELIEF":
        reason = enable_relief()
        if reason:
            raise SystemExit(reason)
        choose_relief(arguments)
    bpy.context.scene.render.film_transparent = True
    bpy.context.scene.render.use_persistent_data = arguments.session
    render("render_s")
    tell(f"measure resident_peak_bytes {cycles_scene.read_peak_resident()}")
    if arguments.session:
        run_session(arguments, scene, things, camera)
    if arguments.output:
        cycles_scene.save_picture(arguments.output)


if __name__ == "__main__":
    main()
