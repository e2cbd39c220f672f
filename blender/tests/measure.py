"""Relief beside Cycles with adaptive subdivision at one pixel, in the same Blender: measure.py [--samples N] [--size WxH].

Each render is a process of its own. Prints a table: time to the first picture, to all samples, peak memory."""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent


def make_scene(arguments):
    """A torus of 64 quads with a map of 2048 x 2048 that folds over, as a subdivision surface, and one light."""
    import bpy
    import numpy as np
    import support
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = (int(part) for part in arguments.size.split("x"))
    scene.render.threads_mode, scene.render.threads = "FIXED", arguments.threads
    scene.world = bpy.data.worlds.new("world")
    support.set_world(scene.world, (0.6, 0.7, 0.9), 0.6)
    support.add_camera((0, -4.4, 3.0), (0, 0, -0.1))
    support.add_light("SUN", (3, -2, 4), energy=3.0)

    def torus(u, v):
        a, b = 2 * np.pi * u, 2 * np.pi * v
        return (1.2 + 0.55 * np.cos(b)) * np.cos(a), (1.2 + 0.55 * np.cos(b)) * np.sin(a), 0.55 * np.sin(b)
    ob = support.make_grid(8, torus, (True, True), lambda u, v: (u, v))
    v, u = np.meshgrid(*[(np.arange(2048) + 0.5) / 2048] * 2, indexing="ij")
    wave = np.sin(48 * np.pi * u) * np.sin(24 * np.pi * v)
    fine = np.sin(240 * np.pi * u) * np.sin(120 * np.pi * v)
    texels = np.stack([0.05 * np.cos(48 * np.pi * u), 0.09 * wave + 0.012 * fine, 0.05 * np.cos(24 * np.pi * v)], -1)
    material = support.make_material(ob, Base_Color=(0.6, 0.4, 0.25), Roughness=0.5)
    image = support.make_image("map", texels.astype(np.float32))
    image.filepath_raw, image.file_format = str(pathlib.Path(arguments.folder) / "map.exr"), "OPEN_EXR"
    image.save()
    loaded = bpy.data.images.load(image.filepath_raw)
    loaded.colorspace_settings.name = "Non-Color"
    support.displace(material, loaded)
    bpy.data.images.remove(image)
    support.subdivide(ob, "CATMULL_CLARK", 2, adaptive=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(pathlib.Path(arguments.folder) / "scene.blend"))


def render(arguments):
    """One render of scene.blend in this process; prints seconds and bytes."""
    import bpy
    import relief_blender
    relief_blender.register()
    bpy.ops.wm.open_mainfile(filepath=str(pathlib.Path(arguments.folder) / "scene.blend"))
    scene = bpy.context.scene
    scene.render.engine = arguments.engine
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 4
    scene.cycles.samples = scene.relief.samples = arguments.samples
    scene.relief.bounces = 4
    scene.render.filepath = str(pathlib.Path(arguments.folder) / f"{arguments.engine.lower()}_{arguments.samples}.png")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    seconds = time.monotonic() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    relief_blender.unregister()
    print("RESULT " + json.dumps({"seconds": seconds, "before": before * 1024, "peak": peak * 1024}), flush=True)


def run(arguments, engine, samples):
    """The result of a render in a process of its own."""
    command = [sys.executable, __file__, "--folder", arguments.folder, "--engine", engine, "--samples", str(samples)]
    answer = subprocess.run(command, capture_output=True, text=True)
    line = next((line for line in answer.stdout.splitlines() if line.startswith("RESULT ")), None)
    if line is None:
        sys.exit(answer.stdout + answer.stderr)
    return json.loads(line.removeprefix("RESULT "))


def compare(arguments):
    subprocess.run([sys.executable, __file__, "--folder", arguments.folder, "--size", arguments.size, "--threads",
                    str(arguments.threads), "--engine", "SCENE"], check=True, stdout=subprocess.DEVNULL)
    found = {engine: [] for engine in ("RELIEF", "CYCLES")}
    for samples in (1, arguments.samples):
        for engine, results in found.items():
            results.append(run(arguments, engine, samples))
            print(engine, samples, results[-1], file=sys.stderr, flush=True)
    rows = [("first picture, s", [found[e][0]["seconds"] for e in found]),
            (f"{arguments.samples} samples, s", [found[e][1]["seconds"] for e in found]),
            ("peak of the process, MiB", [found[e][1]["peak"] / 2 ** 20 for e in found]),
            ("of it for the render, MiB", [(found[e][1]["peak"] - found[e][1]["before"]) / 2 ** 20 for e in found])]
    print("| | Relief | Cycles | ratio |\n|---|---|---|---|")
    for label, (ours, theirs) in rows:
        print(f"| {label} | {ours:.1f} | {theirs:.1f} | {ours / theirs:.2f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", default="out/blender")
    parser.add_argument("--engine", default="")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    arguments.folder = str(pathlib.Path(arguments.folder).resolve())
    pathlib.Path(arguments.folder).mkdir(parents=True, exist_ok=True)
    sys.path[:0] = [str(HERE), str(HERE.parent)]
    if not arguments.engine:
        compare(arguments)
    elif arguments.engine == "SCENE":
        make_scene(arguments)
    else:
        render(arguments)


if __name__ == "__main__":
    main()
