"""Bakes the difference between a base and a detailed mesh to a vector displacement map."""
from typing import NamedTuple

import numpy as np
import relief

from . import mesh_arrays
from .bake_texels import Raster, add_margin


class BaseMesh(NamedTuple):
    """Triangles of the surface that the map is for; all but `points` (triangles, 3, channels)."""
    points: np.ndarray  # (triangles, 3): vertices
    positions: np.ndarray
    normals: np.ndarray
    tangents: np.ndarray  # x, y, z, sign of the bitangent
    uvs: np.ndarray


class BakeSettings(NamedTuple):
    width: int = 1024
    height: int = 1024
    margin: int = 8       # texels
    space: str = "TANGENT"  # or OBJECT
    distance: float = 0.0  # of rays at most; 0: half the diagonal of the detailed mesh


class BakeError(Exception):
    """What is wrong with the meshes, for the user."""


def read_base(mesh, uv_name=""):
    """The BaseMesh of a bpy.types.Mesh: smooth normals, as displacement goes along them, and MikkTSpace."""
    if len(mesh.polygons) == 0:
        raise BakeError("the base has no faces")
    normals, tangents = mesh_arrays.read_frames(mesh, uv_name)
    arrays = mesh_arrays.read_mesh(mesh, uv_name)
    if arrays.uvs is None:
        raise BakeError("the base has no uv map")
    if tangents is None:
        raise BakeError("the base has faces of more than four corners: triangulate it")
    mesh.calc_loop_triangles()
    corners = mesh_arrays.read(mesh.loop_triangles, "loops", 3, np.int32)
    points = arrays.corners[corners]
    return BaseMesh(points, arrays.positions[points], normals[corners], tangents[corners], arrays.uvs[corners])


def find_nearest(intersector, points, normals, distance):
    """Signed distances along normals to the detailed surface, nan where there is none."""
    nudge = distance * 1e-4
    ways = []
    for sign in (1.0, -1.0):
        # From a little behind, as hits at the very start of a ray do not count.
        origins = (points - sign * nudge * normals).astype(np.float32)
        hits = intersector.closest_hits(origins, np.ascontiguousarray(sign * normals, np.float32), t_max=distance)
        t = np.asarray(hits.t, np.float64) - nudge
        ways.append(np.where(np.isfinite(t), sign * t, np.nan))
    up, down = ways
    is_down = np.isnan(up) | (np.abs(down) < np.abs(up))
    return np.where(is_down, down, up)


def into_tangent_space(vectors, normals, tangents):
    """Tangent, normal, bitangent, as the node Vector Displacement has its channels."""
    bitangents = np.cross(normals, tangents[:, :3]) * np.sign(tangents[:, 3:])
    frames = np.stack([tangents[:, :3], normals, bitangents], -1)
    determinant = np.linalg.det(frames)
    frames[np.abs(determinant) < 1e-6] = np.eye(3)
    return np.linalg.solve(frames, vectors[..., None])[..., 0]


def make_map(raster, base, vectors, settings):
    """(height, width, 3) float32 of displacements (texels, 3) of the raster."""
    if settings.space == "TANGENT":
        vectors = into_tangent_space(vectors, raster.interpolate(base.normals), raster.interpolate(base.tangents))
    image, mask = raster.make_image(vectors)
    return add_margin(image, mask, settings.margin)


def make_raster(base, settings, report):
    """The texels of the map. `report` takes a text of what the map cannot hold."""
    raster = Raster(base.uvs, settings.width, settings.height)
    if len(raster.texels) == 0:
        raise BakeError("no texel is inside of the uv map: is it in the unit square?")
    is_inside = (base.uvs >= -1e-4) & (base.uvs <= 1 + 1e-4)
    outside = 1 - np.mean(is_inside.all((1, 2)))
    if outside > 0:
        report(f"uvs of {100 * outside:.2g} % of the triangles are outside of the unit square: nothing is baked there")
    if raster.overlap > 1e-3:
        report(f"{100 * raster.overlap:.2g} % of the texels are of several faces, as of mirrored uvs: the first one counts")
    return raster


def bake_by_rays(raster, base, detailed, settings):
    """(map, share of texels whose rays found nothing) of a relief.Mesh in the axes of the base."""
    if len(detailed.sizes) == 0:
        raise BakeError("the detailed mesh has no faces")
    scene = relief.Scene()
    scene.add(detailed)
    points = raster.interpolate(base.positions)
    normals = raster.interpolate(base.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
    size = np.linalg.norm(np.ptp(np.asarray(detailed.positions), axis=0))
    distances = find_nearest(relief.Intersector(scene), points, normals, settings.distance or size / 2)
    missed = np.isnan(distances)
    vectors = normals * np.where(missed, 0, distances)[:, None]
    return make_map(raster, base, vectors, settings), float(missed.mean())


def bake_by_points(raster, base, moved, settings):
    """The map of points that correspond: `moved` (points, 3) are those of the base after sculpting."""
    vectors = raster.interpolate(moved[base.points] - base.positions)
    return make_map(raster, base, vectors, settings)
