"""Batches of rays."""
from __future__ import annotations

from typing import Any, Iterable, Optional, Sequence, Union

import numpy as np

from . import _relief
from ._arguments import as_integer
from ._arrays import Array, as_floats, to_numpy
from ._render import choose_cache
from ._scene import Renderable, parse_any

NOTHING = 0xFFFFFFFF
HIT_TYPE = np.dtype([("t", "f4"), ("object", "u4"), ("patch", "u4"), ("uv", "f4", 2), ("normal", "f4", 3)])
ATTRIBUTE_TYPE = np.dtype([("shading_normal", "f4", 3), ("dp_du", "f4", 3), ("dp_dv", "f4", 3), ("texture_uv", "f4", 2)])
ATTRIBUTES = {"shading_normal": 1, "texture_uv": 2, "derivatives": 4}


class Hits:
    """Hits of N rays: views of one array of structures, without a copy.

    t: (N,), in units of the ray's direction, infinity where nothing is hit. object: (N,) uint32, index into
    Scene.objects. patch: (N,) uint32, face of the mesh after its refinement to quads. uv: (N, 2), place on the patch.
    normal: (N, 3), geometric, world space, unit length. is_hit: (N,) bool. records: (N,) structures of all of these.
    Where asked for: shading_normal (N, 3), texture_uv (N, 2), dp_du and dp_dv (N, 3). object and patch are NOTHING
    (2^32 - 1) where nothing is hit, all others 0."""

    def __init__(self, records: Array, attributes: Optional[Array], wanted: Sequence[str]) -> None:
        self.records: Array = records.view(HIT_TYPE)[:, 0]
        self.t: Array = self.records["t"]
        self.object: Array = self.records["object"]
        self.patch: Array = self.records["patch"]
        self.uv: Array = self.records["uv"]
        self.normal: Array = self.records["normal"]
        if attributes is None:
            return
        more = attributes.view(ATTRIBUTE_TYPE)[:, 0]
        for name in wanted:
            for field in ("dp_du", "dp_dv") if name == "derivatives" else (name,):
                setattr(self, field, more[field])

    shading_normal: Array
    texture_uv: Array
    dp_du: Array
    dp_dv: Array

    @property
    def is_hit(self) -> Array:
        found: Array = self.object != NOTHING
        return found

    def __len__(self) -> int:
        return len(self.records)


def read_ends(value: Any, name: str, count: int) -> Array:
    if np.ndim(value) == 0:
        return as_floats(np.reshape(value, 1), name, None)
    ends = as_floats(value, name, None)
    if len(ends) != count:
        raise ValueError(f"{name}: {len(ends)} of them, and {count} rays")
    return ends


def read_rays(origins: Any, directions: Any, t_min: Any, t_max: Any) -> Array:
    """(N, 8) float32: origin, t_min, direction, t_max."""
    if directions is None:
        rays = to_numpy(origins, "rays")
        if rays.ndim != 2 or rays.shape[1] != 8:
            raise ValueError(f"rays: the shape is {rays.shape}, not (N, 8); or give origins and directions, (N, 3) each")
        if rays.dtype != np.float32 or not rays.flags.c_contiguous:
            raise TypeError(f"rays: float32 in C order is needed, not {rays.dtype} with strides {rays.strides}")
        _relief.check_rays(rays, "rays")
        return rays
    starts, ways = as_floats(origins, "origins", 3), as_floats(directions, "directions", 3)
    if len(starts) != len(ways):
        raise ValueError(f"directions: the shape is {ways.shape}, and that of origins {starts.shape}")
    rays = _relief.pack_rays(starts, ways, read_ends(t_min, "t_min", len(starts)), read_ends(t_max, "t_max", len(starts)))
    _relief.check_rays(rays, "origins, directions, t_min or t_max")
    return rays


class Intersector:
    """A scene prepared for rays, for any number of threads. scene: a Scene, a Mesh, or the file of a scene or mesh.

    settings: engine, device, threads, level, pixel_error, mode, lod, leaf, cache_mb, isa, structure, traversal, ... of
    render(), and picture_height, 720: pixels of the camera's view, which automatic levels come from. frame: of values with
    keys."""

    def __init__(self, scene: Renderable, frame: Optional[float] = None, **settings: Any) -> None:
        keywords = choose_cache({key: value for key, value in settings.items() if value is not None})
        self._intersector = _relief.Intersector(parse_any(scene, frame), keywords)

    @property
    def warnings(self) -> list[str]:
        return self._intersector.warnings

    def closest_hits(self, origins: Any, directions: Any = None, t_min: Any = 0.0, t_max: Any = np.inf, *,
                     attributes: Sequence[str] = (), mask: int = NOTHING) -> Hits:
        """The nearest hits with t in (t_min, t_max], in world space.

        origins, directions: (N, 3); directions need no unit length, and t is in units of theirs. t_min, t_max: numbers, or
        (N,). Or rays alone, (N, 8) float32 in C order: origin, t_min, direction, t_max, which are read where they are.
        attributes: of shading_normal, texture_uv, derivatives. Arrays of other libraries come by DLPack."""
        if not isinstance(attributes, (str, Iterable)):
            raise TypeError(f"attributes: {attributes!r} is no list of names: {', '.join(ATTRIBUTES)}")
        wanted = [attributes] if isinstance(attributes, str) else list(attributes)
        unknown = [name for name in wanted if not isinstance(name, str) or name not in ATTRIBUTES]
        if unknown:
            raise ValueError(f"attributes: '{unknown[0]}' is not one of {', '.join(ATTRIBUTES)}")
        rays = read_rays(origins, directions, t_min, t_max)
        bits = sum(ATTRIBUTES[name] for name in set(wanted))
        return Hits(*self._intersector.closest_hits(rays, as_integer(mask, "mask", 0, NOTHING), bits), wanted)

    def any_hits(self, origins: Any, directions: Any = None, t_min: Any = 0.0, t_max: Any = np.inf, *,
                 mask: int = NOTHING) -> Array:
        """(N,) bool: whether anything is hit in (t_min, t_max]. Arguments as those of closest_hits()."""
        rays = read_rays(origins, directions, t_min, t_max)
        return self._intersector.any_hits(rays, as_integer(mask, "mask", 0, NOTHING)).view(np.bool_)
