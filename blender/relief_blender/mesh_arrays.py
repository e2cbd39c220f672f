"""Meshes of Blender as NumPy arrays."""
from dataclasses import dataclass

import numpy as np


@dataclass
class MeshArrays:
    """One mesh. Corners are in the order of faces."""
    positions: np.ndarray         # (points, 3)
    sizes: np.ndarray             # (faces,)
    corners: np.ndarray           # (corners,) points
    face_materials: np.ndarray    # (faces,)
    corner_normals: np.ndarray    # (corners, 3)
    uvs: np.ndarray | None = None  # (corners, 2)
    further_uvs: tuple = ()        # the same of each further uv map


def read(items, attribute, width, dtype=np.float32):
    array = np.empty(len(items) * width, dtype)
    items.foreach_get(attribute, array)
    return array.reshape(-1, width) if width > 1 else array


def find_uv_layer(mesh, name):
    """The layer of a name, else the one that renders, else None."""
    layer = mesh.uv_layers.get(name) if name else None
    return layer or next((layer for layer in mesh.uv_layers if layer.active_render), None)


def read_uvs(mesh, name):
    """(corners, 2) of the uv map of a name, else of the one that renders, else None."""
    layer = find_uv_layer(mesh, name)
    return read(layer.uv, "vector", 2) if layer and len(layer.uv) else None


def read_mesh(mesh, uv_name="", further=()):
    """Arrays of a bpy.types.Mesh, with further uv maps; those of a mesh without any are 0."""
    others = [read_uvs(mesh, name) for name in further]
    return MeshArrays(
        positions=read(mesh.vertices, "co", 3), sizes=read(mesh.polygons, "loop_total", 1, np.int32),
        corners=read(mesh.loops, "vertex_index", 1, np.int32),
        face_materials=read(mesh.polygons, "material_index", 1, np.int32),
        corner_normals=read(mesh.corner_normals, "vector", 3),
        uvs=read_uvs(mesh, uv_name),
        further_uvs=tuple(np.zeros((len(mesh.loops), 2), np.float32) if uvs is None else uvs for uvs in others))


def read_float_attribute(mesh, name, domain):
    """Values of an attribute on points or edges, or None where there is none."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != domain or attribute.data_type != "FLOAT":
        return None
    return read(attribute.data, "value", 1)


def read_loose_points(mesh):
    """Points of edges without a face, which Blender keeps as sharp corners."""
    is_loose = np.ones(len(mesh.edges), bool)
    is_loose[read(mesh.loops, "edge_index", 1, np.int32)] = False
    return np.unique(read(mesh.edges, "vertices", 2, np.int32)[is_loose])


def read_creases(mesh):
    """(edges (K, 2), sharpness (K,)): Blender's crease c is a sharpness of 10 c^2; corners are edges of one point."""
    edges, sharpness = np.zeros((0, 2), np.int32), np.zeros(0, np.float32)
    crease = read_float_attribute(mesh, "crease_edge", "EDGE")
    if crease is not None:
        used = crease > 0
        edges, sharpness = read(mesh.edges, "vertices", 2, np.int32)[used], 10 * np.minimum(crease[used], 1) ** 2
    corner = read_float_attribute(mesh, "crease_vert", "POINT")
    if corner is not None:
        points = np.flatnonzero(corner > 0).astype(np.int32)
        edges = np.concatenate([edges, np.stack([points, points], -1)])
        sharpness = np.concatenate([sharpness, 10 * np.minimum(corner[points], 1) ** 2])
    return edges, sharpness.astype(np.float32)


def read_frames(mesh, uv_name):
    """(normals of points at the corners, tangents (corners, 4) or None): of the whole mesh, for its parts.

    Tangents are those of MikkTSpace, which Blender has for triangles and quads alone."""
    corners = read(mesh.loops, "vertex_index", 1, np.int32)
    normals = read(mesh.vertex_normals, "vector", 3)[corners]
    layer = find_uv_layer(mesh, uv_name)
    if layer is None or len(mesh.polygons) and read(mesh.polygons, "loop_total", 1, np.int32).max() > 4:
        return normals, None
    mesh.calc_tangents(uvmap=layer.name)
    tangents = np.concatenate([read(mesh.loops, "tangent", 3), read(mesh.loops, "bitangent_sign", 1)[:, None]], -1)
    mesh.free_tangents()
    return normals, tangents


def index_equal(corners, rows):
    """(rows, indices of the corners): equal rows at one point are one, so that uvs and normals stay connected."""
    first, inverse = find_distinct(np.concatenate([corners[:, None].astype(np.uint32), _read_bits(rows)], -1))
    return rows[first], inverse


def count_places(positions):
    """How many different places points (N, 3) are at."""
    return len(find_distinct(_read_bits(positions + np.float32(0)))[0])  # -0 becomes 0


def _read_bits(rows):
    return np.ascontiguousarray(rows, np.float32).view(np.uint32)


def find_distinct(keys):
    """(first, inverse) of the different rows of (N, columns) uint32: indices of one of each, and of each row the index among
    those. They are in the order of the first column."""
    # One number of 64 bits a row, so that one sort of numbers does; rows of another hash and the same first column follow.
    packed = keys[:, 0].astype(np.uint64) << np.uint64(32) | _hash(keys[:, 1:])
    order = np.argsort(packed, kind="stable")
    packed, in_order = packed[order], keys[order]
    is_new = np.ones(len(keys), bool)
    is_new[1:] = packed[1:] != packed[:-1]
    if np.any(in_order[1:][~is_new[1:]] != in_order[:-1][~is_new[1:]]):  # two rows of one hash: once in a thousand million
        _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        return first, inverse.reshape(-1).astype(np.uint32)
    inverse = np.empty(len(keys), np.uint32)
    inverse[order] = np.cumsum(is_new, dtype=np.uint32) - np.uint32(1)
    return order[is_new], inverse


def _hash(keys):
    """32 bits of each row, as uint64."""
    result = np.zeros(len(keys), np.uint64)
    for column in keys.T:
        result ^= column
        result *= np.uint64(0x9E3779B97F4A7C15)
        result ^= result >> np.uint64(32)
    return result & np.uint64(0xFFFFFFFF)


def select_faces(arrays, is_chosen):
    """(arrays of some faces with their points alone, mask of their corners)."""
    corner_mask = np.repeat(is_chosen, arrays.sizes)
    points, corners = np.unique(arrays.corners[corner_mask], return_inverse=True)
    uvs = arrays.uvs[corner_mask] if arrays.uvs is not None else None
    return MeshArrays(arrays.positions[points], arrays.sizes[is_chosen], corners.reshape(-1).astype(np.int32),
                      arrays.face_materials[is_chosen], arrays.corner_normals[corner_mask], uvs,
                      tuple(further[corner_mask] for further in arrays.further_uvs)), corner_mask
