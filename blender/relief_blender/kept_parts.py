"""A viewport keeps these parts of an export for the next one, unless Blender names them as changed."""
from typing import NamedTuple

import bpy

from .images import TileCache


class KeptMaterial(NamedTuple):
    exported: tuple       # ExportedMaterial
    keys: dict            # relief.Material
    displacement: object  # relief.Displacement, or None


class KeptMeshes(NamedTuple):
    owners: frozenset  # session_uid of the object and of its data
    materials: dict    # {name of a material in the file, "": none: ExportedMaterial}
    parts: list        # MeshParts
    meshes: dict       # {name: relief.Mesh}
    effects: list      # what else the export did to the scene: see MeshExport
    digests: dict      # {name: hash}, of meshes that Blender names as changed though they may be the same


def find_owners(evaluated):
    """Identifies the shape of an evaluated object."""
    original = evaluated.original
    return frozenset(block.session_uid for block in (original, original.data) if block is not None)


class KeptParts:
    """Meshes and materials as they were exported, and tiles of images as they were read."""

    def __init__(self):
        self.tiles = TileCache()
        self._meshes, self._materials, self._used, self._frame = {}, {}, set(), None
        self._doubtful = {}  # of _meshes, those that are named as changed

    def forget_all(self):
        self._meshes, self._materials, self._doubtful = {}, {}, {}

    def follow(self, depsgraph):
        """Forgets what has changed since the last call."""
        if depsgraph.scene.frame_current != self._frame:
            self._frame, self._materials = depsgraph.scene.frame_current, {}
        changed = set()
        for update in depsgraph.updates:
            block = update.id.original
            if isinstance(block, bpy.types.Material):
                self._materials.pop(block.name_full, None)
            elif isinstance(block, (bpy.types.Image, bpy.types.Texture)) or _is_node_group(block):
                self._materials = {}
            if update.is_updated_geometry:
                changed.add(block.session_uid)
        self._doubtful = {key: kept for key, kept in self._meshes.items() if kept.owners & changed}
        self._meshes = {key: kept for key, kept in self._meshes.items() if key not in self._doubtful}

    def find_material(self, name):
        return self._materials.get(name)

    def keep_material(self, name, kept):
        self._materials[name] = kept

    def find_meshes(self, key, evaluated):
        kept = self._meshes.get(key)
        if kept is None or not kept.owners & find_owners(evaluated):
            return None
        self._used.add(key)
        return kept

    def keep_meshes(self, key, kept):
        """{name: relief.Mesh} of the meshes to use, which are those of the export before where they are the same."""
        before = self._doubtful.get(key)
        meshes = dict(kept.meshes)
        for name, digest in kept.digests.items():
            if before is not None and before.digests.get(name) == digest:
                meshes[name] = before.meshes[name]
        self._meshes[key] = kept._replace(meshes=meshes)
        self._used.add(key)
        return meshes

    def forget_unused(self):
        """Keeps what an export has used since the last call."""
        self._meshes = {key: kept for key, kept in self._meshes.items() if key in self._used}
        self._used = set()
        self.tiles.forget_unused()


def _is_node_group(block):
    """Trees that are a material's own come with their material."""
    return isinstance(block, bpy.types.NodeTree) and not block.is_embedded_data
