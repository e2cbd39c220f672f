"""The command relief-usd: a USD file as a scene that `relief render` takes."""
from __future__ import annotations

import argparse
import os
import sys
import tempfile

import relief

from .context import NOTE

FAILED, USAGE, BAD_INPUT = 1, 2, 3  # exit codes of the command relief


def make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="relief-usd", description="Writes the scene of a USD file as a scene of Relief: "
                                     "scene.json with its meshes and maps in the same folder.")
    parser.add_argument("file", help="usd, usda, usdc or usdz")
    parser.add_argument("-o", "--output", required=True, help="FOLDER/scene.json, or FOLDER")
    parser.add_argument("--time", type=float, help="time code; the first frame if not given")
    parser.add_argument("--frames", help="time samples as keys, and meshes whose points change as a file a frame: 1-24, or all; "
                        "one time if not given")
    parser.add_argument("--camera", help="path of the camera; that of the render settings, else the first, if not given")
    parser.add_argument("--purposes", default="default,render", help="purposes of prims that are taken: default,render")
    parser.add_argument("--meters", action="store_true", help="lengths in meters, by the stage's metersPerUnit")
    parser.add_argument("--subdivision-level", type=int, help="of subdivided meshes, 0 to 8; by the picture if not given")
    parser.add_argument("--vector-space", choices=("tangent", "object"), default="tangent",
                        help="what the vectors of MaterialX displacements are")
    parser.add_argument("-q", "--quiet", action="store_true", help="no report of what is not taken over, and no notes")
    return parser


def write(scene: relief.Scene, output: str) -> str:
    """Returns the name of the scene file."""
    folder = os.path.dirname(os.path.abspath(output)) if output.endswith(".json") else output
    if "frames" in scene.render:
        from .save_frames import save_frames

        save_frames(scene, folder)
    else:
        scene.save(folder)
    written = os.path.join(folder, "scene.json")
    if not output.endswith(".json"):
        return written
    if os.path.basename(output) != "scene.json":
        os.replace(written, output)
    return output


def convert(options: argparse.Namespace, report: list) -> tuple:
    """(scene, name of its file)."""
    from . import load

    with tempfile.TemporaryDirectory(prefix="relief-usd-") as folder:  # for numbered files, which are moved from there
        scene = load(options.file, options.time, report=report, camera=options.camera, purposes=options.purposes.split(","),
                     meters=options.meters, subdivision_level=options.subdivision_level, vector_space=options.vector_space,
                     folder=folder, frames=options.frames)
        return scene, write(scene, options.output)


def run(arguments=None) -> int:
    options = make_parser().parse_args(arguments)
    report: list = []
    try:
        scene, name = convert(options, report)
    except ImportError as error:
        print(f"relief-usd: {error}", file=sys.stderr)
        return FAILED
    except relief.Error as error:
        print(f"relief-usd: {error}", file=sys.stderr)
        return {"bad_input": BAD_INPUT, "usage": USAGE}.get(error.kind, FAILED)
    if not options.quiet:
        for line in report:
            print(line if line.startswith(NOTE) else f"not taken over: {line}", file=sys.stderr)
    print(f"wrote {name}: {len(scene.objects)} objects, {len(scene.meshes)} meshes, {len(scene.lights)} lights")
    return 0
