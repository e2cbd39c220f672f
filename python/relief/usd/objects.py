"""Objects of a scene from meshes and shapes of a stage: parts of one material, instances, displacement."""
from __future__ import annotations

import dataclasses

import numpy as np
from pxr import Usd, UsdGeom, UsdShade

import relief

from .context import Context
from .corners import Faces, have_area
from .deforming import write_moving_mesh
from .displacements import find_noted
from .instances import write_instances
from .manifold import is_manifold
from .materials import MaterialReader, ReadMaterial
from .meshes import RawMesh, make_mesh, name_uvs, read_mesh, refine_mesh
from .motion import find_carrier
from .shapes import can_read_shape, read_shape
from .walk import Item

MANY = 256  # places of a point instancer from which on they go into one file


@dataclasses.dataclass
class Part:
    """The faces of a mesh that have one material."""
    prim: Usd.Prim  # of the mesh or the subset
    faces: Faces
    material: ReadMaterial | None


class ObjectReader:
    def __init__(self, context: Context) -> None:
        self.context, self.materials = context, MaterialReader(context)
        self.raw: dict = {}            # meshes by the prim that holds them
        self.refined: dict = {}        # subdivided ones of several materials, likewise
        self.refined_uvs: dict = {}    # the uvs that their materials want
        self.manifold: dict = {}       # whether subdivided ones are, likewise
        self.meshes: dict = {}         # names in the scene of parts of them
        self.displacements: dict = {}  # names in the scene by their keys
        self.paths_of_names: dict = {} # of objects: for light linking
        self.has_uvs: dict = {}        # of meshes by their names
        self.emitters = 0

    def emits(self) -> bool:
        return self.emitters > 0

    def can_read(self, prim: Usd.Prim) -> bool:
        return prim.IsA(UsdGeom.Mesh) or can_read_shape(prim)

    def add(self, item: Item) -> None:
        prim = item.prim
        key = find_key(prim)
        if key not in self.raw:
            read = read_mesh if prim.IsA(UsdGeom.Mesh) else read_shape
            self.raw[key] = self.keep_solid(read(self.context, prim))
        raw = self.raw[key]
        if raw is None:
            return
        parts = self.split(prim, raw)
        if raw.is_subdivided() and (len(parts) > 1 or not self.is_manifold(key, raw)):
            raw = self.refine(key, raw, parts)
        for part in parts:
            if len(parts) > 1 and not have_area(raw.positions, part.faces).any():
                self.context.report.add(part.prim, "its faces have no area: it is left out")
            else:
                self.add_part(item, raw, part, len(parts) > 1)

    def keep_solid(self, raw: RawMesh | None) -> RawMesh | None:
        """None where no face has an area, which a scene refuses."""
        if raw is not None and len(raw.faces.sizes) and not have_area(raw.positions, raw.faces).any():
            self.context.report.add(raw.prim, "its faces have no area: it is left out")
            return None
        return raw

    def split(self, prim: Usd.Prim, raw: RawMesh) -> list:
        """The mesh in its subsets of materials, and what is in none of them."""
        bound = self.materials.read_bound(prim)
        subsets = UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets() if prim.IsA(UsdGeom.Mesh) else []
        parts, left = [], raw.faces.numbers
        for subset in subsets:
            numbers = np.array(self.context.get(subset.GetIndicesAttr(), []), np.int64)
            material = self.materials.read_bound(subset.GetPrim()) or bound
            parts.append(Part(subset.GetPrim(), raw.faces.select(np.intersect1d(left, numbers)), material))
            left = np.setdiff1d(left, numbers)
        if len(left):
            parts.append(Part(prim, raw.faces.select(left), bound))
        parts = [part for part in parts if len(part.faces.sizes)]
        if len(parts) == 1:
            return [Part(prim, raw.faces, parts[0].material)]
        if parts:
            self.context.report.note(prim, f"is split into {len(parts)} objects, one a material")
        return parts

    def refine(self, key: str, raw: RawMesh, parts: list) -> RawMesh:
        """Refined as a whole, so that parts meet; the parts' faces become those of the finer mesh."""
        if key not in self.refined:
            wanted = tuple(name for part in parts if part.material
                           for name in (part.material.uvs, *part.material.further_uvs) if name) or (None,)
            self.refined[key] = refine_mesh(self.context, raw, wanted)
            self.refined_uvs[key] = wanted
        fine = self.refined[key]
        for part in parts:
            part.faces = fine.faces.select(part.faces.numbers)
        reason = "as its parts have to meet" if len(parts) > 1 else "as its faces are no closed sheet"
        self.context.report.note(raw.prim, f"is subdivided into {len(fine.faces.sizes)} flat faces, {reason}")
        return fine

    def is_manifold(self, key: str, raw: RawMesh) -> bool:
        if key not in self.manifold:
            self.manifold[key] = is_manifold(raw.positions, raw.faces)
        return self.manifold[key]

    def add_part(self, item: Item, raw: RawMesh, part: Part, is_split: bool) -> None:
        keys = {}
        displaced = self.find_displacement(item.prim, part)
        wanted = (part.material.uvs, *part.material.further_uvs) if part.material else (None,)
        if displaced is not None:
            displaced = dict(displaced)
            wanted = (displaced.pop("uvs", None) or wanted[0], *wanted[1:])
            if is_split:
                self.keep_closed(part, displaced)
        mesh_name = self.find_mesh(raw, part, wanted, is_split and displaced is not None)
        has_uvs = self.has_uvs[mesh_name]
        if displaced is not None and not has_uvs:
            self.context.report.add(item.prim, "has no uvs: its displacement is left out")
            displaced = None
        material = part.material
        if material is not None and material.needs_uvs and not has_uvs:
            self.context.report.add(item.prim, "has no uvs: its material, which needs them, is left out")
            material = None
        keys["mesh"] = mesh_name
        if displaced is not None:
            keys["displacement"] = self.name_displacement(displaced, part)
        if material is not None:
            keys["material"] = material.name
            self.emitters += material.emits
        catcher = find_attribute(item.prim, "relief:shadow_catcher")
        if catcher:
            keys["shadow_catcher"] = True
        self.place(item, part, keys)

    def keep_closed(self, part: Part, displaced: dict) -> None:
        """Along the normals of the whole mesh, so that parts meet."""
        if displaced.get("type") == "height" or displaced.get("space", "tangent") == "tangent":
            if displaced.get("frame", "mikk") != "file":
                displaced["frame"] = "file"
                if displaced.pop("lengths", "absolute") == "relative":
                    self.context.report.add(part.prim, "is displaced along unit tangents, as a part of a mesh")

    def find_displacement(self, prim: Usd.Prim, part: Part) -> dict | None:
        noted = find_noted(self.context, part.prim)
        if noted is not None:
            return noted
        return part.material.displacement if part.material else None

    def name_displacement(self, keys: dict, part: Part) -> str:
        identity = repr(sorted(keys.items(), key=lambda pair: pair[0]))
        if identity not in self.displacements:
            base = keys.get("name") or (part.material.name if part.material else part.prim.GetName())
            name, number = base, 1
            while name in self.context.scene.displacements:
                number += 1
                name = f"{base}_{number}"
            rest = {key: value for key, value in keys.items() if key not in ("file", "name")}
            self.context.scene.displacements[name] = relief.Displacement(keys["file"], **rest)
            self.displacements[identity] = name
        return self.displacements[identity]

    def find_mesh(self, raw: RawMesh, part: Part, wanted: tuple, with_normals: bool) -> str:
        """The name of a part's mesh in the scene; one mesh for all of its instances. `wanted`: names of its own uvs and of
        further sets."""
        uvs = tuple(name_uvs(self.context, raw, name) for name in wanted)
        key = (find_key(raw.prim), uvs, with_normals, part.faces.numbers.tobytes())
        if key not in self.meshes:
            mesh = make_mesh(self.context, raw, part.faces, uvs, with_normals)
            noted = raw.prim.GetAttribute("relief:mesh_name")
            base = (noted.Get() if noted and noted.Get() else None) or part.prim.GetName()
            name, number = base, 1
            while name in self.context.scene.meshes:
                number += 1
                name = f"{base}_{number}"
            is_fine = raw is self.refined.get(find_key(raw.prim))
            moving = write_moving_mesh(self.context, raw.prim, name, lambda: self.remake(raw, part, uvs, with_normals, is_fine),
                                       len(uvs))
            self.context.scene.meshes[name] = moving or mesh
            self.meshes[key] = name
            self.has_uvs[name] = mesh.uvs is not None and len(mesh.uvs) > 0
        return self.meshes[key]

    def remake(self, raw: RawMesh, part: Part, uvs: tuple, with_normals: bool, is_fine: bool) -> relief.Mesh:
        """A part at another time of the context."""
        again = read_mesh(self.context, raw.prim)
        if again is None:
            self.context.fail(raw.prim, f"is no mesh{self.context.describe_time()}", "its points have to be finite at all frames")
        if is_fine:
            again = refine_mesh(self.context, again, self.refined_uvs[find_key(raw.prim)])
        return make_mesh(self.context, again, part.faces, uvs, with_normals)

    def place(self, item: Item, part: Part, keys: dict) -> None:
        """One object, or one for each place of an instancer, or all of them in one file of points."""
        noted = find_attribute(item.prim, "relief:name")
        base = noted or str(part.prim.GetPath())
        matrices = item.matrices.reshape(-1, 4, 4)
        if item.instancer is not None:
            base = f"{item.instancer.GetPath()}{part.prim.GetPath()}"
        carrier = find_carrier(self.context, item)
        if carrier is None or item.instancer is not None:
            matrices = self.leave_out_flat(item, matrices)
        if carrier is not None:
            matrices = carrier.compute_rest(matrices) if item.instancer is not None else np.eye(4)[None]
            if matrices is None:
                self.context.report.add(item.instancer, "has no extent at the frame, and is left out")
                return
        if len(matrices) >= MANY:
            points = write_instances(self.context, matrices)
            if points is not None:
                moved = {} if carrier is None else {"transform": carrier.make_transform(np.eye(4))}
                self.add_object(base, {**keys, "instances": {"file": points}, **moved}, item, part)
                return
        for number, matrix in enumerate(matrices):
            name = base if len(matrices) == 1 else f"{base}[{number}]"
            transform = make_still(matrix) if carrier is None else carrier.make_transform(matrix)
            if transform is None:
                self.context.report.add(item.prim, "has no extent at any frame, and is left out")
                continue
            self.add_object(name, {**keys, **({"transform": transform} if transform else {})}, item, part)

    def leave_out_flat(self, item: Item, matrices: np.ndarray) -> np.ndarray:
        is_flat = ~(np.abs(np.linalg.det(matrices[:, :3, :3])) > 0)
        if is_flat.any() or not np.isfinite(matrices).all():
            self.context.report.add(item.instancer or item.prim, "stands in places without extent, which are left out")
            matrices = matrices[~is_flat & np.isfinite(matrices).all((1, 2))]
        return matrices

    def add_object(self, name: str, entry: dict, item: Item, part: Part) -> None:
        self.context.scene.objects.append({"name": name, **entry})
        self.paths_of_names.setdefault(name, (item.instancer or part.prim).GetPath())


def make_still(matrix: np.ndarray) -> dict:
    """Keys of a transform; none where it changes nothing."""
    return {} if np.array_equal(matrix, np.eye(4)) else {"matrix": [float(x) for x in matrix.reshape(-1)]}


def find_key(prim: Usd.Prim) -> str:
    """One for all instances of a prim."""
    return str((prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath())


def find_attribute(prim: Usd.Prim, name: str):
    """Its value on the prim or the nearest of its ancestors that has it."""
    while prim and not prim.IsPseudoRoot():
        attribute = prim.GetAttribute(name)
        if attribute and attribute.Get() is not None:
            return attribute.Get()
        prim = prim.GetParent()
    return None
