"""Evaluated meshes as meshes of Relief: one a mesh and material."""
import hashlib
from typing import NamedTuple

import bpy
import numpy as np
import relief

from . import mesh_arrays, mesh_repair, subdivision, topology
from .kept_parts import KeptMeshes, find_owners
from .values import Place


class MeshPart(NamedTuple):
    """A mesh in the scene and the material that it is for."""
    mesh: str
    material: str
    displacement: str | None
    is_world_height: bool


def find_materials(evaluated, mesh):
    """Materials by slot: of the object where a slot says so, else of the mesh."""
    slots = evaluated.material_slots
    result = [m for m in mesh.materials] or [None]
    for i, slot in enumerate(slots):
        if slot.link == "OBJECT" and i < len(result):
            result[i] = slot.material
    return result


def digest(mesh):
    """A hash of all that a relief.Mesh has."""
    whole = hashlib.blake2b(repr((mesh.subdivision, sorted(mesh.further_uvs))).encode(), digest_size=16)
    arrays = [mesh.positions, mesh.sizes, mesh.corners, mesh.uvs, mesh.uv_indices, mesh.normals, mesh.normal_indices,
              mesh.tangents, mesh.creases, mesh.sharpness]
    for array in arrays + [array for number in sorted(mesh.further_uvs) for array in mesh.further_uvs[number]]:
        whole.update(b"" if array is None else repr(array.shape).encode())
        whole.update(b"" if array is None else np.ascontiguousarray(array))
    return whole.digest()


class MeshExport:
    """Adds meshes to a relief.Scene, each once for all objects that share it."""

    def __init__(self, scene, materials, depsgraph, report, kept=None):
        """kept: a KeptParts, where the same meshes may come again."""
        self._scene, self._materials, self._depsgraph, self._report = scene, materials, depsgraph, report
        self._done, self._kept = {}, kept
        self._effects = []  # (method, argument) that change more of the scene than its meshes, of the object at hand
        self._named = {}    # {name of a material in the file: ExportedMaterial} of the object at hand

    def export(self, evaluated, is_made_by_nodes=False):
        """The MeshParts of an evaluated object. Geometry nodes make instances of meshes that are no object's own."""
        slots = tuple(slot.material.name_full if slot.material else "" for slot in evaluated.material_slots
                      if slot.link == "OBJECT")
        modifier = None if is_made_by_nodes else subdivision.find_modifier(evaluated, self._depsgraph)
        owner = evaluated.original.name_full if modifier else ""
        # Blender subdivides the mesh of an evaluated object when it is asked for: with a cage nobody asks.
        data = evaluated.original.data if modifier else evaluated.data
        key = (data.as_pointer(), slots, owner)
        if key not in self._done:
            self._done[key] = self._take_kept(key, evaluated) if self._kept else None
        if self._done[key] is None:
            self._done[key] = self._make_and_keep(key, evaluated, modifier)
        return self._done[key]

    def _take_kept(self, key, evaluated):
        """The MeshParts of an export before, or None."""
        kept = self._kept.find_meshes(key, evaluated)
        if kept is None or any(name in self._scene.meshes for name in kept.meshes):
            return None
        if self._export_named(kept.materials) != kept.materials:
            return None
        self._effects = []  # not those that are kept
        for method, argument in kept.effects:
            getattr(self, method)(argument)
        self._scene.meshes.update(kept.meshes)
        return kept.parts

    def _export_named(self, names):
        """{name: ExportedMaterial}, without materials that the file has no more."""
        known = {material.name_full: material for material in bpy.data.materials}
        return {name: self._materials.export(known[name].evaluated_get(self._depsgraph) if name else None)
                for name in names if not name or name in known}

    def _make_and_keep(self, key, evaluated, modifier):
        self._effects, self._named = [], {}
        before = set(self._scene.meshes)
        parts = self._make(evaluated, modifier)
        if self._kept and self._depsgraph.view_layer.material_override is None:
            meshes = {name: mesh for name, mesh in self._scene.meshes.items() if name not in before}
            digests = {name: digest(mesh) for name, mesh in meshes.items()} if modifier else {}
            kept = KeptMeshes(find_owners(evaluated), self._named, parts, meshes, self._effects, digests)
            self._scene.meshes.update(self._kept.keep_meshes(key, kept))
        return parts

    def _make(self, evaluated, modifier):
        if modifier:
            with subdivision.cage_of(evaluated, modifier, self._depsgraph) as cage:
                parts = self._add_cage(evaluated, cage, modifier)
            if parts is not None:
                return parts
        # In Edit Mode the faces are not in the data itself.
        if evaluated.type == "MESH" and not evaluated.data.is_editmode:
            return self._add_mesh(evaluated, evaluated.data)
        mesh = evaluated.to_mesh()
        try:
            return self._add_mesh(evaluated, mesh) if mesh else []
        finally:
            evaluated.to_mesh_clear()

    def _used(self, evaluated, mesh):
        """{slot: ExportedMaterial} of the slots that faces use; slots beyond the last are the last."""
        override = self._depsgraph.view_layer.material_override
        materials = [override] if override else find_materials(evaluated, mesh)
        materials = [material.evaluated_get(self._depsgraph) if material else None for material in materials]
        indices = np.unique(np.minimum(mesh_arrays.read(mesh.polygons, "material_index", 1, np.int32), len(materials) - 1))
        used = {int(i): self._materials.export(materials[i]) for i in indices}
        for i, exported in used.items():
            self._named[materials[i].name_full if materials[i] else ""] = exported
        return used

    def _add_cage(self, evaluated, cage, modifier):
        """Parts of a subdivision surface; None where its faces are of several materials that Relief cannot join."""
        name = evaluated.original.name_full

        def report(text):
            self._report.add("object", name, text)
        used = self._used(evaluated, cage)
        if not used:
            return []
        adaptive = subdivision.is_adaptive(evaluated, modifier)
        if len(used) > 1:
            if adaptive:
                report("several materials on an adaptive subdivision: it is subdivided by its Levels instead")
            return None
        material = next(iter(used.values()))
        arrays = mesh_arrays.read_mesh(cage, material.base.uv_map, material.further)
        repaired = mesh_repair.repair(arrays, report)
        if repaired is None:
            return []
        arrays = repaired[0]
        if modifier.subdivision_type != "CATMULL_CLARK":
            return self._add(evaluated, arrays, material)
        if not topology.can_be_subdivided(arrays):
            report("its cage has points at one place, edges of three faces or faces turned against each other: "
                   "it is subdivided by its Levels")
            return None
        subdivision.report_differences(modifier, report)
        keys = subdivision.make_keys(modifier, adaptive, subdivision.find_level(modifier, self._depsgraph),
                                     material.displacement is not None)
        creases = subdivision.read_creases(modifier, cage, arrays, report)
        if creases is not None:
            keys["creases"] = True
        return self._add(evaluated, arrays, material, subdivision=keys, creases=creases)

    def _add_mesh(self, evaluated, mesh):
        used = self._used(evaluated, mesh)
        if len(used) == 1:
            material = next(iter(used.values()))
            return self._add(evaluated, mesh_arrays.read_mesh(mesh, material.base.uv_map, material.further), material)
        parts = [self._add_part(evaluated, mesh, slot, material, max(used)) for slot, material in used.items()]
        return [part for some in parts for part in some]

    def _add_part(self, evaluated, mesh, slot, material, last):
        """The faces of one material; displaced ones take their frames from the whole mesh, so that borders meet."""
        whole = mesh_arrays.read_mesh(mesh, material.base.uv_map, material.further)
        part, mask = mesh_arrays.select_faces(whole, np.minimum(whole.face_materials, last) == slot)
        tangents = None
        if material.is_tangent:
            normals, tangents = mesh_arrays.read_frames(mesh, material.base.uv_map)
            part.corner_normals = normals[mask]
            tangents = tangents[mask] if tangents is not None else None
            if tangents is None:
                self._report.add("object", evaluated.original.name_full,
                                 "borders of its displaced materials may open: it has faces of more than four corners")
            else:
                material = material._replace(displacement=self._make_framed(material.displacement))
        return self._add(evaluated, part, material, tangents=tangents)

    def _make_framed(self, displacement):
        """The same displacement in the frames that come with a mesh."""
        self._effects.append(("_make_framed", displacement))
        name = f"{displacement} in given frames"
        if name not in self._scene.displacements:
            framed = relief.Displacement(**self._scene.displacements[displacement])
            framed["frame"] = "file"
            self._scene.displacements[name] = framed
            self._materials.derived[name] = (displacement, 1.0)
        return name

    def _add(self, evaluated, arrays, material, **keys):
        """Adds a mesh to the scene. A list of its MeshPart, empty where it cannot be rendered."""
        if material.is_volume_only:
            self._report.add("object", evaluated.original.name_full,
                             f'material "{material.material}" has a volume and no surface: its faces are left out')
            return []
        repaired = mesh_repair.repair(arrays, lambda text: self._report.add("object", evaluated.original.name_full, text))
        if repaired is None:
            return []
        arrays, mask = repaired
        if keys.get("tangents") is not None:
            keys["tangents"] = keys["tangents"][mask]
        name = self._make_name(evaluated, material)
        uvs = uv_indices = None
        if arrays.uvs is not None:
            uvs, uv_indices = mesh_arrays.index_equal(arrays.corners, self._place_uvs(arrays.uvs, material.base))
        else:
            material = self._leave_out_maps(evaluated, material)
        if arrays.further_uvs:
            keys["further_uvs"] = {number: mesh_arrays.index_equal(arrays.corners, further)
                                   for number, further in enumerate(arrays.further_uvs, 1)}
        normals, normal_indices = mesh_arrays.index_equal(arrays.corners, arrays.corner_normals)
        self._scene.meshes[name] = relief.Mesh(
            arrays.positions, (arrays.sizes, arrays.corners), uvs=uvs, uv_indices=uv_indices, normals=normals,
            normal_indices=normal_indices, **{key: value for key, value in keys.items() if value is not None})
        return [MeshPart(name, material.material, material.displacement, material.is_world_height)]

    def _leave_out_maps(self, evaluated, material):
        """The ExportedMaterial of a mesh without uvs."""
        if material.displacement is not None:
            self._report.add("object", evaluated.original.name_full, "it has no uv map: it is not displaced")
        self._effects.append(("_leave_out_normal_map", material.material))
        plain = self._leave_out_normal_map(material.material)
        if plain is not None:
            self._report.add("object", evaluated.original.name_full, "it has no uv map: its normal map is left out")
        return material._replace(material=plain or material.material, displacement=None)

    def _leave_out_normal_map(self, material):
        return self._materials.leave_out_normal_map(material)

    @staticmethod
    def _place_uvs(uvs, base):
        if base == Place(base.uv_map):
            return uvs
        return (uvs * np.array(base.scale, np.float32) + np.array(base.offset, np.float32)).astype(np.float32)

    def _make_name(self, evaluated, material):
        data = evaluated.original.data
        stem = f"{data.name} of {material.material}" if data else material.material
        name, number = stem, 1
        while name in self._scene.meshes:
            number += 1
            name = f"{stem} {number}"
        return name
