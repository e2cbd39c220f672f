"""Polygon meshes from arrays."""
from __future__ import annotations

import os
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

import numpy as np

from . import _relief
from ._arrays import Array, as_floats, as_indices, check_finite, is_array, to_numpy


def split_faces(faces: Any) -> tuple[Array, Array]:
    """Sizes of faces and their corners, flat."""
    if isinstance(faces, tuple) and len(faces) == 2 and all(is_array(part) and to_numpy(part, "faces").ndim == 1 for part in faces):
        sizes, corners = (to_numpy(part, "faces") for part in faces)
    elif is_array(faces):
        array = to_numpy(faces, "faces")
        if array.ndim != 2 or array.shape[1] < 3:
            raise ValueError(f"faces: the shape is {array.shape}, not (F, 3) or (F, 4)")
        sizes, corners = np.full(len(array), array.shape[1], np.uint32), array.reshape(-1)
    else:
        given = list(faces) if isinstance(faces, Iterable) else [faces]
        if not all(isinstance(face, Iterable) for face in given):
            raise TypeError(f"faces: an array, a list of lists, or a tuple of sizes and corners is needed, not {faces!r:.60}")
        rows = [list(face) for face in given]
        sizes = np.array([len(row) for row in rows], np.uint32)
        corners = np.array([corner for row in rows for corner in row], dtype=None if rows else np.uint32)
    for name, part in (("sizes of faces", sizes), ("faces", corners)):
        if part.size and part.dtype.kind not in "iu":
            raise TypeError(f"{name}: integers are needed, not {part.dtype} {part.shape}")
    if sizes.size and int(sizes.min()) < 3:
        raise ValueError(f"faces: face {int(sizes.argmin())} has {int(sizes.min())} corners, 3 are needed")
    if int(sizes.sum()) != len(corners):
        raise ValueError(f"faces: sizes add up to {int(sizes.sum())}, and there are {len(corners)} corners")
    return np.ascontiguousarray(sizes, dtype=np.uint32), corners


class Mesh:
    """Polygons. Arrays of float32 and uint32 in C order are kept without a copy; others are converted.

    positions: (N, 3), scene units, y up.
    faces: (F, 3) or (F, 4) integers, counter-clockwise; a list of lists; or a tuple of two flat arrays, the sizes of the
        faces and the corners of all of them.
    uvs: (C, 2), one for each of the C corners of all faces; or (M, 2) with uv_indices, (C,) or of the shape of faces.
    further_uvs: uv sets of textures that name one by `uv_set`: a dict of numbers, 1 to 255, to (C, 2), or to tuples of
        (M, 2) and indices. `uvs` are set 0; displacements and normal maps lie on them.
    normals: (C, 3), or (M, 3) with normal_indices, likewise; unit length.
    tangents: (C, 4), unit x, y, z and the sign of the bitangent.
    creases: (K, 3), rows of two indices of positions and a sharpness, 10 being infinitely sharp; or a tuple of edges (K, 2)
        and sharpness (K,).
    subdivision: dict of the scene file's key: scheme, level, uv, boundary, creases.
    weld: distance at which open edges are joined, scene units; None: rounding errors, 0: never.
    warnings: what of the file that it was loaded from does not show in it.

    The attributes hold the arrays; `sizes` and `corners` are those of the faces, `uv_set` is the number of the set that
    `uvs` are, `further_uvs` holds tuples of uvs and indices or None. They may be replaced or written to."""

    def __init__(self, positions: Any, faces: Any, uvs: Any = None, uv_indices: Any = None, normals: Any = None,
                 normal_indices: Any = None, tangents: Any = None, creases: Any = None,
                 subdivision: Optional[Mapping[str, Any]] = None, further_uvs: Optional[Mapping[int, Any]] = None,
                 weld: Optional[float] = None) -> None:
        self.positions: Array = as_floats(positions, "positions", 3)
        self.sizes, corners = split_faces(faces)
        self.corners: Array = as_indices(corners, "faces", len(self.positions))
        self.uvs, self.uv_indices = self._read_attribute(uvs, uv_indices, "uvs", 2)
        self.uv_set = 0
        self.further_uvs: dict[int, tuple[Array, Optional[Array]]] = self._read_further_uvs(further_uvs or {})
        self.normals, self.normal_indices = self._read_attribute(normals, normal_indices, "normals", 3)
        self.tangents: Optional[Array] = None if tangents is None else as_floats(tangents, "tangents", 4)
        self.creases: Optional[Array] = None
        self.sharpness: Optional[Array] = None
        if creases is not None:
            self._read_creases(creases)
        if not isinstance(subdivision, (Mapping, type(None))):
            raise TypeError(f"subdivision: a dict of scheme, level, ... is needed, not {subdivision!r:.60}")
        self.subdivision: Optional[dict[str, Any]] = None if subdivision is None else dict(subdivision)
        self.weld: Optional[float] = None if weld is None else float(weld)
        self.warnings: list[str] = []
        self._collect()

    def _read_attribute(self, values: Any, indices: Any, name: str, width: int) -> tuple[Optional[Array], Optional[Array]]:
        if values is None:
            if indices is not None:
                raise ValueError(f"{name[:-1]}_indices: there are no {name}")
            return None, None
        array = as_floats(values, name, width)
        if indices is None:
            return array, None
        flat = to_numpy(indices, f"{name[:-1]}_indices").reshape(-1)
        return array, as_indices(flat, f"{name[:-1]}_indices", len(array))

    def _read_further_uvs(self, sets: Mapping[int, Any]) -> dict[int, tuple[Array, Optional[Array]]]:
        """Numbers to uvs and indices, checked."""
        found: dict[int, tuple[Array, Optional[Array]]] = {}
        for number, given in sets.items():
            name = f"further_uvs[{number!r}]"
            if isinstance(number, bool) or not isinstance(number, (int, np.integer)) or not 0 <= number <= 255:
                raise ValueError(f"{name}: the number of a uv set is a whole one, 0 to 255")
            if number == self.uv_set:
                raise ValueError(f"{name}: uvs are set {number}")
            values, indices = given if isinstance(given, tuple) and len(given) == 2 else (given, None)
            uvs = as_floats(values, name, 2)
            check_finite(uvs, name)
            if indices is not None:
                indices = as_indices(to_numpy(indices, name).reshape(-1), name, len(uvs))
            self._check_count(uvs, indices, name)
            found[int(number)] = (uvs, indices)
        return found

    def _read_creases(self, creases: Any) -> None:
        if not hasattr(creases, "__len__"):
            raise TypeError(f"creases: rows of two points and a sharpness are needed, not {creases!r:.60}")
        if isinstance(creases, tuple) and len(creases) == 2:
            edges, sharpness = to_numpy(creases[0], "creases"), as_floats(creases[1], "sharpness of creases", None)
        else:
            rows = as_floats(np.zeros((0, 3)) if len(creases) == 0 else creases, "creases", 3)
            edges = np.asarray(to_numpy(creases, "creases")[:, :2] if len(rows) else np.zeros((0, 2)))
            if edges.dtype.kind == "f" and not (np.isfinite(edges).all() and (edges == np.floor(edges)).all()):
                raise ValueError("creases: the first two of a row are indices of positions, whole numbers")
            edges, sharpness = edges.astype(np.int64), np.ascontiguousarray(rows[:, 2])
        self.creases, self.sharpness = self._check_edges(edges), sharpness

    def _check_edges(self, value: Any) -> Array:
        edges = to_numpy(value, "creases")
        if edges.ndim != 2 or edges.shape[1] != 2:
            raise ValueError(f"creases: the shape of edges is {edges.shape}, not (K, 2)")
        return as_indices(edges.reshape(-1), "creases", len(self.positions)).reshape(-1, 2)

    def _check_count(self, array: Optional[Array], indices: Optional[Array], name: str) -> None:
        if array is None:
            return
        label = name if indices is None else f"{name[:-1]}_indices" if name.endswith("s") else f"indices of {name}"
        counted = array if indices is None else indices
        if len(counted) != len(self.corners):
            hint = f"; of points they are {name}[faces.ravel()]" if len(counted) == len(self.positions) else ""
            raise ValueError(f"{label}: {len(counted)}, and there are {len(self.corners)} corners of faces{hint}")

    _has_let_go = False

    def _let_go(self) -> None:
        """Lets go of the arrays, for a scene that knows the mesh."""
        self.positions, self.sizes, self.corners = np.zeros((0, 3), np.float32), np.zeros(0, np.uint32), np.zeros(0, np.uint32)
        for name in ("uvs", "uv_indices", "normals", "normal_indices", "tangents", "creases", "sharpness"):
            setattr(self, name, None)
        self.further_uvs = {}
        self._has_let_go = True

    def _collect(self) -> dict[str, Any]:
        """The arrays that there are, checked: they may have been changed."""
        if self._has_let_go and len(self.sizes) == 0:
            raise ValueError("its arrays were let go of (release=True), and this is another scene: give a new Mesh")
        arrays: dict[str, Any] = {"positions": as_floats(self.positions, "positions", 3)}
        check_finite(arrays["positions"], "positions")
        arrays["sizes"], corners = split_faces((to_numpy(self.sizes, "sizes"), to_numpy(self.corners, "corners")))
        arrays["corners"] = as_indices(corners, "faces", len(self.positions))
        for name, width in (("uvs", 2), ("normals", 3), ("tangents", 4)):
            values = getattr(self, name)
            if values is None:
                continue
            arrays[name] = as_floats(values, name, width)
            check_finite(arrays[name], name)
            indices = getattr(self, f"{name[:-1]}_indices", None)
            if indices is not None:
                arrays[f"{name[:-1]}_indices"] = as_indices(indices, f"{name[:-1]}_indices", len(values))
            self._check_count(arrays[name], indices, name)
        if self.uv_set:
            arrays["uv_set"] = int(self.uv_set)
        if self.further_uvs:
            arrays["further_uvs"] = self._read_further_uvs(self.further_uvs)
        if self.creases is not None and self.sharpness is not None:
            arrays["creases"] = self._check_edges(self.creases)
            arrays["sharpness"] = as_floats(self.sharpness, "sharpness of creases", None)
            check_finite(arrays["sharpness"], "sharpness of creases")
            if len(arrays["creases"]) != len(arrays["sharpness"]):
                raise ValueError(f"creases: {len(arrays['creases'])} edges and {len(arrays['sharpness'])} sharpnesses")
        return arrays

    @classmethod
    def _from_arrays(cls, arrays: Mapping[str, Any]) -> Mesh:
        """Of arrays that the library made."""
        mesh = cls.__new__(cls)
        mesh.positions = arrays.get("positions", np.zeros((0, 3), np.float32))
        mesh.sizes = arrays.get("sizes", np.zeros(0, np.uint32))
        mesh.corners = arrays.get("corners", np.zeros(0, np.uint32))
        for name in ("uvs", "uv_indices", "normals", "normal_indices", "tangents", "creases", "sharpness"):
            setattr(mesh, name, arrays.get(name))
        mesh.uv_set = arrays.get("uv_set", 0)
        mesh.further_uvs = dict(arrays.get("further_uvs", {}))
        mesh.subdivision = None
        mesh.weld = None
        mesh.warnings = []
        return mesh

    @classmethod
    def load(cls, file: Union[str, os.PathLike[str]], uv_set: int = 0, further_uv_sets: Sequence[int] = ()) -> Mesh:
        """Reads .obj, .ply, .gltf, .glb or .fbx. uv_set: of glTF and FBX, from 0. further_uv_sets: those of them that are
        there become further_uvs."""
        arrays, warnings = _relief.load_mesh(os.fspath(file), uv_set, list(further_uv_sets))
        mesh = cls._from_arrays(arrays)
        mesh.warnings = warnings
        return mesh

    def save(self, file: Union[str, os.PathLike[str]]) -> None:
        """Writes .obj or binary .ply: faces, and uvs of the first set; the file is replaced atomically."""
        _relief.write_mesh(self._collect(), os.fspath(file))

    @property
    def faces(self) -> Union[Array, list[Array]]:
        """(F, k) where all faces have k corners, else a list of arrays."""
        if len(self.sizes) and int(self.sizes.min()) == int(self.sizes.max()):
            return self.corners.reshape(len(self.sizes), -1)
        return np.split(self.corners, np.cumsum(self.sizes)[:-1]) if len(self.sizes) else []

    def __repr__(self) -> str:
        return f"Mesh({len(self.positions)} positions, {len(self.sizes)} faces)"
