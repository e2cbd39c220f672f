"""Meshes that deform while the shutter is open: a numbered file for each step, between which Relief blends."""
import copy
import pathlib
import tempfile

import bpy
import numpy as np
import relief

from .mesh_export import MeshExport
from .report import Report
from .scene_export import is_made_by_nodes
from .shutter import can_deform
from .subdivision import find_modifier


def may_deform(evaluated, depsgraph):
    """Whether anything could move points of an evaluated object against each other; a subdivision surface alone does not."""
    original = evaluated.original
    data = original.data
    if original.type != "MESH" or data.animation_data or data.shape_keys:
        return True
    own = 1 if find_modifier(evaluated, depsgraph) else 0
    return len(original.modifiers) > own or original.parent_type in {"ARMATURE", "LATTICE"}


def find_corner_normals(mesh):
    return mesh.normals[mesh.normal_indices]


def is_same_mesh(a, b):
    return (has_same_faces(a, b) and np.array_equal(a.positions, b.positions) and np.array_equal(a.uvs, b.uvs)
            and np.array_equal(find_corner_normals(a), find_corner_normals(b)))


def has_same_faces(a, b):
    """Whether something lies between two meshes. Normals may be joined otherwise."""
    arrays = ("sizes", "corners", "uv_indices", "creases", "sharpness")
    counts = ("positions", "uvs")
    return (all(np.array_equal(getattr(a, name), getattr(b, name)) for name in arrays)
            and all(np.shape(getattr(a, name)) == np.shape(getattr(b, name)) for name in counts))


def transform_mesh(mesh, matrix):
    """A mesh as a 4x4 matrix that does not mirror places it."""
    result = copy.copy(mesh)
    linear = matrix[:3, :3]
    result.positions = (mesh.positions @ linear.T + matrix[:3, 3]).astype(np.float32)
    normals = mesh.normals @ np.linalg.inv(linear)
    lengths = np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-30)
    result.normals = (normals / lengths).astype(np.float32)
    return result


class MeshMotion:
    """Meshes of a SceneExport at the steps of a Shutter."""

    def __init__(self, exporter, shutter, report):
        self._exporter, self._shutter, self._report = exporter, shutter, report
        self._looked_at = {}  # {name: relief.Mesh of each frame of Relief; None: it was another one}
        self._owners = {}     # {name: name of an object}
        self._baked = {}

    def begin(self, step, depsgraph):
        """Meshes are looked at in steps that are whole frames of Relief."""
        self._seen, self._depsgraph = set(), depsgraph
        scratch = relief.Scene()
        scratch.displacements = self._exporter.scene.displacements
        self._scratch = scratch if step % self._shutter.stride == 0 else None
        self._export = MeshExport(scratch, self._exporter.materials, depsgraph, Report())

    def look_at(self, instance, entries):
        """An instance at this step, and its objects in the scene."""
        evaluated, names = instance.object, tuple(entry["mesh"] for entry in entries)
        if self._scratch is None or names in self._seen or not can_deform(evaluated.original):
            return
        if not may_deform(evaluated, self._depsgraph):
            return
        self._seen.add(names)
        parts = self._export.export(evaluated, is_made_by_nodes(instance))
        for name, part in zip(names, parts if len(parts) == len(names) else [None] * len(names)):
            self._owners[name] = evaluated.original.name_full
            self._looked_at.setdefault(name, []).append(self._scratch.meshes[part.mesh] if part else None)

    def bake(self, entry, matrices):
        """Lets the mesh of an object of the scene do what its transform cannot. matrices: {step: 4x4}. Whether it can."""
        steps = range(0, self._shutter.step_count + 1, self._shutter.stride)
        if ("displacement" in entry or self._exporter.scene.meshes[entry["mesh"]].further_uvs
                or any(s not in matrices or np.linalg.det(matrices[s][:3, :3]) <= 0 for s in steps)):
            return False
        meshes = self._find_sequence(entry["mesh"]) or [self._exporter.scene.meshes[entry["mesh"]]] * len(steps)
        name = f"{entry['mesh']} in place {len(self._baked)}"
        self._baked[name] = [transform_mesh(mesh, matrices[s]) for mesh, s in zip(meshes, steps)]
        entry["mesh"] = name
        del entry["transform"]
        return True

    def write(self):
        """Puts numbered files into the scene. Returns their folder, None where nothing deforms."""
        sequences = {name: self._find_sequence(name) for name in self._looked_at}
        sequences = {name: meshes for name, meshes in {**sequences, **self._baked}.items() if meshes}
        if not sequences:
            return None
        folder = tempfile.TemporaryDirectory(prefix="relief_", dir=bpy.app.tempdir or None)
        for number, (name, meshes) in enumerate(sequences.items()):
            pattern = str(pathlib.Path(folder.name) / f"{number}.####.obj")
            for frame, mesh in enumerate(meshes):
                mesh.save(pattern.replace("####", f"{frame:04}"))
            keys = {"file": pattern, "subdivision": meshes[0].subdivision}
            self._exporter.scene.meshes[name] = {key: value for key, value in keys.items() if value is not None}
        return folder

    def _find_sequence(self, name):
        """The meshes of all frames of Relief, or None: it does not deform, or not as Relief can, which is reported."""
        def tell(text):
            self._report.add("object", self._owners[name], f"motion blur: {text}")
        base, meshes = self._exporter.scene.meshes[name], self._looked_at.get(name, [])
        if all(mesh is not None and is_same_mesh(base, mesh) for mesh in meshes):
            return None
        if len(meshes) <= self._shutter.length:
            tell("it is not there all the time that the shutter is open: it does not deform meanwhile")
        elif not all(mesh is not None and has_same_faces(base, mesh) for mesh in meshes):
            tell("its faces or uvs are others from one step to the next: it does not deform meanwhile")
        elif base.further_uvs:
            tell("its textures lie on several uv maps: it does not deform meanwhile")
        elif base.tangents is not None:
            tell("it has several materials that displace it in tangent space: it does not deform meanwhile")
        else:
            if self._shutter.stride > 1:
                tell(f"it deforms in {self._shutter.length} steps, which are the most")
            return meshes
        return None
