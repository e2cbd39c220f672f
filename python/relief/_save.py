"""Folders of scenes that move: the scene at its first frame, with keys and the names of numbered files put back."""
from __future__ import annotations

import json
import os
from typing import Any, Mapping

from . import _relief

NUMBER = "##"  # at least: docs/shots.md
OF_PICTURE = ("frames", "fps")  # which a scene in memory does not keep
# Keys of materials that stand for the same under other names, of which a file has one.
OTHER_NAMES = (*(({row["alias"]}, {row["name"]}) for row in _relief.material_inputs()
                 if row["alias"] and row["alias"] != "emission"),
               ({"emission"}, {"emission_luminance", "emission_color"}))


def names_file(key: str) -> bool:
    """Whether texts of this key are names of files, as the reader of scene files takes them."""
    return key in ("file", "geometry_normal") or key.endswith("_texture")


def is_moving(value: Any, key: str = "") -> bool:
    """Whether it has keys or numbered files somewhere inside. key: of the value."""
    if isinstance(value, Mapping):
        return "keys" in value or "animation" in value or any(is_moving(part, inner) for inner, part in value.items())
    if isinstance(value, list):
        return any(is_moving(part, key) for part in value)
    return isinstance(value, str) and names_file(key) and NUMBER in value


def put_motion(file: str, saved: dict[str, Any], scene: Mapping[str, Any], folder: str) -> None:
    """Writes the scene file anew. saved: what it holds, at one frame. scene: all of the scene, with names of files that are
    relative to `folder`."""
    for key in OF_PICTURE:
        if key in scene.get("render", {}):
            saved.setdefault("render", {})[key] = scene["render"][key]
    if is_moving(scene.get("camera")) or "shutter" in scene.get("camera", {}):
        saved["camera"] = scene["camera"]
    put_values(saved.get("environment", {}), scene.get("environment", {}), folder)
    for section in ("materials", "displacements", "meshes"):
        for name, part in scene.get(section, {}).items():
            saved_part = saved.get(section, {}).get(name)
            if saved_part is None:
                continue
            if is_of_files(part):
                saved[section][name] = resolve(part, folder)
            else:
                put_values(saved_part, part, folder)
    for section in ("objects", "lights"):
        for saved_part, part in zip(saved.get(section, []), scene.get(section, [])):
            put_values(saved_part, part, folder)
    with open(file, "w", encoding="utf-8") as stream:
        json.dump(saved, stream, indent=2)


def is_of_files(part: Any) -> bool:
    """Whether a map or mesh is another file at each frame: all that is said of it is said of these."""
    return "animation" in part or is_moving(part.get("file"), "file")


def put_values(saved: dict[str, Any], part: Mapping[str, Any], folder: str) -> None:
    moving = {key for key, value in part.items() if is_moving(value, key)}
    for pair in OTHER_NAMES:
        for names, others in (pair, pair[::-1]):
            if moving & names:
                moving |= names & part.keys()
                for other in others & saved.keys():
                    del saved[other]
    saved.update({key: resolve(part[key], folder, key) for key in part if key in moving})


def resolve(value: Any, folder: str, key: str = "") -> Any:
    """With whole names of files. key: of the value, which names with keys ([[frame, name], ...]) are names of as well."""
    if isinstance(value, Mapping):
        return {inner: resolve(part, folder, key if inner == "keys" else inner) for inner, part in value.items()}
    if isinstance(value, list):
        return [resolve(part, folder, key) for part in value]
    return os.path.join(os.path.abspath(folder), value) if isinstance(value, str) and names_file(key) else value
