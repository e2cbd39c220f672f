"""Pictures of a stage: whether Relief reads them, others as arrays through Pillow, and those that nobody reads left out."""
from __future__ import annotations

import glob
import os
import re

import numpy as np

import relief
from relief import _relief

from .context import Context

TOKEN = "<UDIM>"
OTHER_TOKENS = ("<UVTILE>", "<uvtile>", "<udim>", "##")  # of names that Relief alone expands


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


def list_tiles(file: str) -> list:
    """Names of the files that a name stands for."""
    if TOKEN not in file:
        return [file]
    return sorted(glob.glob(glob.escape(file).replace(glob.escape(TOKEN), "[0-9]" * 4)))


def find_fault(file: str) -> str | None:
    """Why Relief does not read a picture; None where it does."""
    if any(token in file for token in OTHER_TOKENS):
        return None
    names = list_tiles(file)
    if not names:
        return "there is no such file"
    for name in names:
        try:
            _relief.read_texture(name)
        except relief.Error as error:
            return str(error.message) + (f" ({error.hint})" if error.hint else "")
    return None


class PictureChecker:
    """Looks at each picture of a scene once."""

    def __init__(self, context: Context) -> None:
        self.report = context.report
        self.known: dict = {}  # names: what stands in their place; None: nothing can

    def check(self, file, place: str):
        """What is to be read: the file, or an array; None where it is left out."""
        if not isinstance(file, str):
            return file
        if file not in self.known:
            fault = find_fault(file)
            array = None if fault is None else read_tiles(file) if TOKEN in file else read_picture(file)
            self.known[file] = (file if fault is None else array, fault)
        found, fault = self.known[file]
        if found is None:
            self.report.add(place, f"picture {os.path.basename(file)} cannot be read and is left out: {fault}")
        return found

    def check_key(self, holder: dict, key: str, place: str) -> bool:
        """Whether a picture is there and stays."""
        if holder.get(key) is None:
            return True
        found = self.check(holder[key], place)
        if found is not None:
            holder[key] = found
        return found is not None


def check_material(checker: PictureChecker, name: str, material: dict) -> None:
    for key, value in list(material.items()):
        place = f"material {name}"
        if key.endswith("_texture") and isinstance(value, str):
            if checker.check(value, place) is None:
                del material[key]
        elif isinstance(value, dict) and not checker.check_key(value, "file", place):
            if "factor" in value:
                material[key] = value["factor"]
            else:
                del material[key]


def check_pictures(context: Context) -> None:
    """Names pictures that cannot be read and takes them out of the scene, so that the rest of it loads."""
    scene, checker = context.scene, PictureChecker(context)
    for name, material in scene.materials.items():
        check_material(checker, name, material)
    for name, displacement in list(scene.displacements.items()):
        if not checker.check_key(displacement, "file", f"displacement {name}"):
            del scene.displacements[name]
            for entry in scene.objects:
                if entry.get("displacement") == name:
                    del entry["displacement"]
    if scene.environment is not None and not checker.check_key(scene.environment, "file", "environment"):
        for key in ("file", "color_space"):
            scene.environment.pop(key, None)
    for number, light in enumerate(scene.lights):
        if not checker.check_key(light, "color_texture", f"light {number}"):
            del light["color_texture"]
