"""UsdGeomMesh to the arrays of relief.Mesh."""
from __future__ import annotations

import dataclasses

import numpy as np
from pxr import Usd, UsdGeom

import relief

from .context import Context, is_number, to_array
from .corners import (Faces, compute_creased_normals, compute_normals, find_next, have_area, index_corners, make_faces,
                      weld)
from .refine import Cage, refine

UV_NAMES = ("st", "uv", "UVMap", "st0", "map1", "Texture_uv")
SCHEMES = {"catmullClark": "catmark", "bilinear": "bilinear"}
BOUNDARIES = {"edgeOnly": "edge-only", "edgeAndCorner": "edge-and-corner"}
MAX_SHARPNESS = 10.0
MAX_LEVEL = 8
FARTHEST = 1e18  # of points from the origin
MAX_FINE_FACES = 250_000
FINE_LEVELS = ((4096, 3), (65536, 2))  # levels that meshes up to so many faces are refined to as polygons; 1 above


@dataclasses.dataclass
class RawMesh:
    """A mesh as arrays, before it is split into parts of one material."""
    prim: Usd.Prim
    positions: np.ndarray
    faces: Faces
    normals: tuple | None = None      # (values, interpolation, indices or None)
    creases: np.ndarray | None = None # (K, 3)
    subdivision: dict | None = None
    counts: tuple = (0, 0, 0)         # of points, faces and corners as the file has them
    uvs: dict | None = None           # in place of primvars: by their names, each as normals

    def is_subdivided(self) -> bool:
        return self.subdivision is not None


def read_mesh(context: Context, prim: Usd.Prim) -> RawMesh | None:
    """None where the prim has no faces, or points that are nowhere."""
    mesh = UsdGeom.Mesh(prim)
    positions = to_array(context.get(mesh.GetPointsAttr()), 3)
    sizes = to_array(context.get(mesh.GetFaceVertexCountsAttr()), dtype=np.int64)
    points = to_array(context.get(mesh.GetFaceVertexIndicesAttr()), dtype=np.int64)
    check_topology(context, prim, positions, sizes, points)
    is_bad = ~(np.abs(positions) <= FARTHEST).all(1)
    if is_bad.any():
        row = int(np.flatnonzero(is_bad)[0])
        context.report.add(prim, f"point {row} is not finite, or farther out than {FARTHEST:g}: it is left out")
        return None
    is_left = context.get(mesh.GetOrientationAttr()) == UsdGeom.Tokens.leftHanded
    holes = to_array(context.get(mesh.GetHoleIndicesAttr()), dtype=np.int64)
    faces = make_faces(sizes, points, is_left, holes)
    if (sizes < 3).any():
        context.report.add(prim, f"{int((sizes < 3).sum())} faces of less than three corners are left out")
    if len(faces.sizes) == 0:
        context.report.add(prim, "has no faces")
        return None
    raw = RawMesh(prim, positions, faces, counts=(len(positions), len(sizes), len(points)))
    read_subdivision(context, mesh, raw)
    if raw.is_subdivided():
        if len(holes):
            context.report.add(prim, "holes of a subdivided mesh have rims like those of an open mesh")
    else:
        raw.normals = read_normals(context, mesh, raw.counts)
    is_posed = any(path in context.baked for path in prim.GetPath().GetPrefixes())
    if not is_posed and (prim.HasRelationship("skel:skeleton") or prim.HasRelationship("skel:blendShapeTargets")):
        context.report.add(prim, "skinning and blend shapes are not applied: it is in its rest pose")
    return raw


def check_topology(context: Context, prim: Usd.Prim, positions, sizes, points) -> None:
    if len(sizes) and (sizes.min() < 0 or sizes.sum() != len(points)):
        context.fail(prim, f"faceVertexCounts sum up to {sizes.sum()}, but there are {len(points)} faceVertexIndices")
    if len(points) and (points.min() < 0 or points.max() >= len(positions)):
        context.fail(prim, f"faceVertexIndices are {points.min()} to {points.max()}, but there are {len(positions)} points")


def choose_level(context: Context, prim: Usd.Prim) -> int | str:
    """The level noted on the prim, that of the options, or auto."""
    noted = context.get_whole(prim, "relief:subdivision:level", 0, MAX_LEVEL)
    if noted is not None:
        return noted
    if context.options.subdivision_level is not None:
        return context.options.subdivision_level
    return "auto"


def read_subdivision(context: Context, mesh: UsdGeom.Mesh, raw: RawMesh) -> None:
    scheme = context.get(mesh.GetSubdivisionSchemeAttr(), "catmullClark")
    if scheme == "none":
        return
    if scheme not in SCHEMES:
        context.report.add(raw.prim, f"subdivision scheme {scheme} is not taken over: its faces are flat")
        return
    boundary = context.get(mesh.GetInterpolateBoundaryAttr(), "edgeAndCorner")
    if boundary not in BOUNDARIES:
        context.report.add(raw.prim, f"interpolateBoundary {boundary} is taken as edgeOnly")
    rule = context.get(mesh.GetFaceVaryingLinearInterpolationAttr(), "cornersPlus1")
    if rule not in ("all", "cornersPlus1", "cornersPlus2", "cornersOnly"):
        context.report.add(raw.prim, f"faceVaryingLinearInterpolation {rule} is taken as cornersPlus1")
    raw.subdivision = {"scheme": SCHEMES[scheme], "level": choose_level(context, raw.prim),
                       "uv": "linear" if rule == "all" else "smooth",
                       "boundary": BOUNDARIES.get(boundary, "edge-only")}
    raw.creases = read_creases(context, mesh, raw)
    raw.subdivision["creases"] = raw.creases is not None


def read_creases(context: Context, mesh: UsdGeom.Mesh, raw: RawMesh) -> np.ndarray | None:
    """(K, 3): two points and a sharpness; a corner names its point twice."""
    indices = to_array(context.get(mesh.GetCreaseIndicesAttr()), dtype=np.int64)
    lengths = to_array(context.get(mesh.GetCreaseLengthsAttr()), dtype=np.int64)
    sharpness = to_array(context.get(mesh.GetCreaseSharpnessesAttr()))
    corners = to_array(context.get(mesh.GetCornerIndicesAttr()), dtype=np.int64)
    corner_sharpness = to_array(context.get(mesh.GetCornerSharpnessesAttr()))
    ends = np.cumsum(lengths)
    is_first = np.ones(len(indices), bool)
    edge_count = int(np.maximum(lengths - 1, 0).sum())
    count = len(raw.positions)
    if (len(indices) != lengths.sum() or len(sharpness) not in (len(lengths), edge_count)
            or len(corners) != len(corner_sharpness) or (lengths < 0).any()
            or not np.isfinite(np.concatenate([sharpness, corner_sharpness])).all()
            or ((indices < 0) | (indices >= count)).any() or ((corners < 0) | (corners >= count)).any()):
        context.report.add(raw.prim, "its creases do not fit together and are left out")
        return None
    is_first[ends[(ends > 0)] - 1] = False
    first = np.flatnonzero(is_first)
    values = np.repeat(sharpness, np.maximum(lengths - 1, 0)) if len(sharpness) == len(lengths) else sharpness
    rows = [np.column_stack([indices[first], indices[first + 1], values]), np.column_stack([corners, corners, corner_sharpness])]
    found = np.concatenate(rows).astype(np.float64)
    found[:, 2] = np.clip(found[:, 2], 0, MAX_SHARPNESS)
    is_kept = are_edges(raw, found[:, :2].astype(np.int64))
    if not is_kept.all():
        context.report.add(raw.prim, f"{int((~is_kept).sum())} of its creases are along no edge and are left out")
    return found[is_kept] if is_kept.any() else None


def are_edges(raw: RawMesh, ends: np.ndarray) -> np.ndarray:
    """Which pairs of points are the ends of an edge of a face that is there, or one point twice."""
    points, faces = weld(raw.positions), raw.faces
    is_there = np.repeat(have_area(raw.positions, faces), faces.sizes)
    edges = np.stack([points[faces.points], points[faces.points[find_next(faces)]]], 1)[is_there]
    keys = [np.sort(pairs, axis=1) @ [len(points), 1] for pairs in (edges, points[ends])]
    return (ends[:, 0] == ends[:, 1]) | np.isin(keys[1], keys[0])


def read_normals(context: Context, mesh: UsdGeom.Mesh, counts: tuple):
    """(values, interpolation, indices or None) of primvars:normals, else of the attribute normals."""
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    if primvar and primvar.HasValue():
        values, interpolation, indices = primvar.Get(context.time), primvar.GetInterpolation(), primvar.GetIndices(context.time)
    else:
        values, interpolation, indices = context.get(mesh.GetNormalsAttr()), mesh.GetNormalsInterpolation(), None
    values = to_array(values, 3)
    indices = to_array(indices, dtype=np.int64) if indices is not None and len(indices) else None
    return check_values(context, mesh.GetPrim(), "normals", (values, interpolation, indices), counts)


def check_values(context: Context, prim: Usd.Prim, name: str, found: tuple, counts: tuple):
    """The values of a primvar where they fit the mesh; else None, and a line in the report."""
    values, interpolation, indices = found
    if len(values) == 0:
        return None
    needed = {"constant": 1, "uniform": counts[1], "faceVarying": counts[2]}.get(interpolation, counts[0])
    have = len(values) if indices is None else len(indices)
    is_bad = indices is not None and (indices.min() < 0 or indices.max() >= len(values))
    if have < needed or is_bad or not np.isfinite(values).all():
        context.report.add(prim, f"{name} do not fit its {interpolation} interpolation and are left out")
        return None
    return found


def choose_uvs(context: Context, prim: Usd.Prim, wanted: str | None) -> str | None:
    """The name of the primvar of uvs: the wanted ones, else of a usual name, else any."""
    kinds = ("texCoord2f[]", "float2[]", "texCoord2d[]", "texCoord2h[]", "double2[]", "half2[]")
    found = [p.GetPrimvarName() for p in UsdGeom.PrimvarsAPI(prim).FindPrimvarsWithInheritance()
             if p.HasValue() and str(p.GetTypeName()) in kinds]
    names = [name for name in (wanted, *UV_NAMES) if name in found] or found
    if wanted is not None and wanted not in found and found:
        context.report.add(prim, f"has no uvs {wanted}: {names[0]} is used")
    return names[0] if names else None


def read_uvs(context: Context, prim: Usd.Prim, name: str | None, counts: tuple):
    """(values, interpolation, indices or None); None without a name, or where they do not fit."""
    if name is None:
        return None
    primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(name)
    indices = primvar.GetIndices(context.time) if primvar.IsIndexed() else None
    indices = to_array(indices, dtype=np.int64) if indices is not None and len(indices) else None
    values = to_array(primvar.Get(context.time), 2)
    return check_values(context, prim, f"uvs {name}", (values, primvar.GetInterpolation(), indices), counts)


def find_uvs(context: Context, raw: RawMesh, name: str | None):
    """As read_uvs, of any mesh."""
    return read_uvs(context, raw.prim, name, raw.counts) if raw.uvs is None else raw.uvs.get(name)


def name_uvs(context: Context, raw: RawMesh, wanted: str | None) -> str | None:
    """As choose_uvs, of any mesh."""
    if raw.uvs is None:
        return choose_uvs(context, raw.prim, wanted)
    return wanted if wanted in raw.uvs else next(iter(raw.uvs), None)


def index_values(faces: Faces, found: tuple) -> np.ndarray:
    chosen = index_corners(faces, found[1])
    return chosen if found[2] is None else found[2][chosen]


def make_further_uvs(context: Context, raw: RawMesh, part: Faces, names: tuple) -> dict:
    """Of the names, by numbers from 1 on; a part without any uvs has them at (0, 0)."""
    found = {}
    for number, name in enumerate(names, 1):
        uvs = find_uvs(context, raw, name)
        if uvs is None:
            found[number] = (np.zeros((1, 2), np.float32), np.zeros(len(part.points), np.uint32))
        else:
            found[number] = (uvs[0].astype(np.float32), index_values(part, uvs).astype(np.uint32).reshape(-1))
    return found


def read_weld(context: Context, prim: Usd.Prim) -> float | None:
    """As noted on the prim."""
    attribute = prim.GetAttribute("relief:weld")
    value = attribute.Get() if attribute else None
    if value is not None and not (is_number(value) and 0 <= value < np.inf):
        context.fail(prim, f"relief:weld is {value!r}", "it has to be a distance of 0 or more")
    return None if value is None else float(value)


def make_mesh(context: Context, raw: RawMesh, part: Faces, uv_names: tuple, with_normals: bool) -> relief.Mesh:
    """One part of a mesh, or the whole. `uv_names`: of its own uvs, then of further sets. `with_normals`: one normal for each
    point of the whole mesh."""
    keys, subdivision = {}, raw.subdivision
    uvs = find_uvs(context, raw, uv_names[0])
    if uvs is not None:
        keys.update(uvs=uvs[0].astype(np.float32), uv_indices=index_values(part, uvs).astype(np.uint32))
        if subdivision is not None and uvs[1] == "varying":
            subdivision = dict(subdivision, uv="linear")
    if len(uv_names) > 1:
        keys["further_uvs"] = make_further_uvs(context, raw, part, uv_names[1:])
    if raw.normals is not None and not with_normals:
        keys.update(normals=raw.normals[0].astype(np.float32), normal_indices=index_values(part, raw.normals).astype(np.uint32))
    elif with_normals and subdivision is None:
        keys.update(normals=compute_normals(raw.positions, raw.faces).astype(np.float32),
                    normal_indices=part.points.astype(np.uint32))
    weld = read_weld(context, raw.prim)
    if weld is not None:
        keys["weld"] = weld
    positions, points, creases = raw.positions, part.points, raw.creases
    if len(part.sizes) < len(raw.faces.sizes):
        used, points = np.unique(points, return_inverse=True)
        positions, creases = positions[used], renumber_creases(creases, used)
    if subdivision is not None:
        keys["subdivision"] = dict(subdivision, creases=creases is not None)
        if creases is not None:
            keys["creases"] = creases
    sides = (part.sizes.astype(np.uint32), points.astype(np.uint32).reshape(-1))
    return relief.Mesh(positions.astype(np.float32), sides, **keys)


def renumber_creases(creases: np.ndarray | None, used: np.ndarray) -> np.ndarray | None:
    """Those between points that are used, by their new numbers."""
    if creases is None:
        return None
    edges = creases[:, :2].astype(np.int64)
    is_in = np.isin(edges, used).all(1)
    found = creases[is_in].copy()
    found[:, :2] = np.searchsorted(used, edges[is_in])
    return found if len(found) else None


def refine_mesh(context: Context, raw: RawMesh, wanted_uvs: tuple) -> RawMesh:
    """A subdivided mesh as one of polygons on its limit surface, with uvs of these names."""
    names = list(dict.fromkeys(name_uvs(context, raw, name) for name in wanted_uvs))
    sets = {name: uvs for name in names if (uvs := find_uvs(context, raw, name)) is not None}
    columns = [uvs[0][index_values(raw.faces, uvs)].reshape(-1, 2) for uvs in sets.values()]
    corner_uvs = np.concatenate([np.zeros((len(raw.faces.points), 0)), *columns], 1)
    rows = np.zeros((0, 3)) if raw.creases is None else raw.creases
    is_edge = rows[:, 0] != rows[:, 1]
    point_sharpness = np.zeros(len(raw.positions))
    point_sharpness[rows[~is_edge, 0].astype(np.int64)] = rows[~is_edge, 2]
    cage = Cage(raw.positions, raw.faces.sizes, raw.faces.points, corner_uvs, raw.faces.numbers,
                rows[is_edge, :2].astype(np.int64), rows[is_edge, 2], point_sharpness,
                raw.subdivision["scheme"] == "catmark", raw.subdivision["boundary"] == "edge-and-corner")
    level = raw.subdivision["level"]
    if level == "auto":
        level = next((fine for most, fine in FINE_LEVELS if len(raw.faces.sizes) <= most), 1)
    if context.options.subdivision_level is None:
        while level > 1 and len(raw.faces.sizes) * 4 ** level > MAX_FINE_FACES:
            level -= 1
    fine = refine(cage, level)
    faces = Faces(fine.sizes, fine.corners, np.arange(len(fine.corners)), fine.faces)
    refined = RawMesh(raw.prim, fine.points, faces, counts=(len(fine.points), len(fine.sizes), len(fine.corners)))
    if cage.is_smooth:
        refined.normals = (compute_creased_normals(fine.points, faces), "faceVarying", None)
    refined.uvs = {name: (fine.uvs[:, 2 * k:2 * k + 2], "faceVarying", None) for k, name in enumerate(sets)}
    return refined
