"""Pictures of kinds that the Python module does not read itself, JPEG above all, as arrays through Pillow."""
from __future__ import annotations

import glob
import os
import re

import numpy as np

from .context import Context

OWN = (".exr", ".png")


def read_picture(file: str):
    """(H, W, C) of uint8; None where Pillow is not installed or does not know the file."""
    try:
        from PIL import Image
    except ImportError:
        return None
    try:
        with Image.open(file) as picture:
            if picture.mode in ("I", "F") or picture.mode.startswith("I;"):
                return None  # more than 8 bits
            wanted = picture.mode if picture.mode in ("L", "RGB", "RGBA") else "RGBA" if "A" in picture.mode else "RGB"
            array = np.array(picture.convert(wanted))
    except (OSError, ValueError):
        return None
    return array if array.ndim == 3 else array[:, :, None]


def read_tiles(file: str) -> dict | None:
    pattern = re.compile(re.escape(os.path.basename(file)).replace(re.escape("<UDIM>"), r"(\d{4})") + "$")
    found = {}
    for name in sorted(glob.glob(glob.escape(file).replace(glob.escape("<UDIM>"), "[0-9]" * 4))):
        array = read_picture(name)
        if array is None:
            return None
        found[int(pattern.match(os.path.basename(name)).group(1))] = array
    return found or None


def read_other_pictures(context: Context) -> None:
    """Replaces the names of such files all over the scene."""
    scene, read = context.scene, {}

    def replace(holder, key: str, place: str) -> None:
        file = holder.get(key)
        if not isinstance(file, str) or os.path.splitext(file)[1].lower() in OWN:
            return
        if file not in read:
            read[file] = read_tiles(file) if "<UDIM>" in file else read_picture(file)
        if read[file] is None:
            context.report.add(place, f"{os.path.basename(file)} needs a Relief with OpenImageIO; Pillow helps with 8 bits, EXR with more")
        else:
            holder[key] = read[file]

    for name, material in scene.materials.items():
        for value in material.values():
            if isinstance(value, dict):
                replace(value, "file", f"material {name}")
    for name, displacement in scene.displacements.items():
        replace(displacement, "file", f"displacement {name}")
    if scene.environment is not None:
        replace(scene.environment, "file", "environment")
    for number, light in enumerate(scene.lights):
        replace(light, "color_texture", f"light {number}")
