"""Scene files with keys, and the numbered files of moving meshes beside them."""
from __future__ import annotations

import json
import os
import shutil

import relief
from relief._scene import strip_comments

SINGLE = "_texture", "file"  # ends of keys whose files Scene.save() has written under names of its own


def save_frames(scene: relief.Scene, folder: str) -> None:
    """Writes scene.json, meshes and maps as Scene.save() does, with all keys and the numbered files of moving meshes."""
    scene._save_still(folder)
    path = os.path.join(folder, "scene.json")
    with open(path, encoding="utf-8") as file:
        root = json.loads(strip_comments(file.read()))
    root["camera"] = dict(scene.camera)
    root.setdefault("render", {}).update({key: scene.render[key] for key in ("frames", "fps") if key in scene.render})
    if scene.environment is not None:
        put_values(root["environment"], scene.environment)
    for saved, light in zip(root.get("lights", []), scene.lights, strict=True):
        put_values(saved, light)
    for saved, entry in zip(root["objects"], scene.objects, strict=True):
        if "transform" in entry:
            saved["transform"] = entry["transform"]
    for name, mesh in scene.meshes.items():
        if isinstance(mesh, dict) and "##" in str(mesh["file"]):
            root["meshes"][name]["file"] = move_files(mesh["file"], folder, root["meshes"][name]["file"])
    with open(path, "w", encoding="utf-8") as file:
        json.dump(root, file, indent=2)


def put_values(saved: dict, part: dict) -> None:
    saved.update({key: value for key, value in part.items() if not key.endswith(SINGLE)})


def move_files(pattern: str, folder: str, single: str) -> str:
    """Into the folder of the scene, in place of the mesh of one frame; returns their name there."""
    os.remove(os.path.join(folder, single))
    target = os.path.join(os.path.dirname(single), os.path.basename(pattern)).replace(os.sep, "/")
    stem, ending = os.path.basename(pattern).split("####")
    for name in os.listdir(os.path.dirname(pattern)):
        number = name.removeprefix(stem).removesuffix(ending)
        if name == stem + number + ending and number.removeprefix("-").isdigit():
            shutil.move(os.path.join(os.path.dirname(pattern), name), os.path.join(folder, os.path.dirname(single), name))
    return target
