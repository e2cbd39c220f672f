"""Structures and traversals of the papers that Relief follows, to be compared.

    relief.trees.traversals("kdtree")
    relief.Intersector(scene, structure="kdtree", traversal="push-down")
    relief.trees.compare(scene, rays)

docs/structures.md says what each is. All find the same hits."""
from __future__ import annotations

import time
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _relief
from ._arguments import as_integer
from ._rays import Intersector
from ._scene import Path, Scene

MOST_REPEATS = 1000000

__all__ = ["structures", "traversals", "compare"]


def structures() -> list[str]:
    """Names of the structures, the default first."""
    return _relief.structures()


def traversals(structure: str = "bvh", engine: str = "cpu") -> list[str]:
    """Names of the traversals of a structure that an engine has, the default first."""
    return _relief.traversals(structure, engine)


def compare(scene: Union[Scene, Path], rays: Any, structures: Optional[Sequence[str]] = None, repeats: int = 3,
            **settings: Any) -> list[dict[str, Any]]:
    """Takes the same rays through each traversal of each structure.

    rays: (N, 8) float32, as for Intersector.closest_hits(). settings: of Intersector. Returns a dict for each: structure,
    traversal, prepare_s, seconds (the least of `repeats` calls), rays_per_second, and same_hits, the share of rays whose t is
    that of the first."""
    table: list[dict[str, Any]] = []
    first, repeats = None, as_integer(repeats, "repeats", 1, MOST_REPEATS)
    for structure in structures or _relief.structures():
        for traversal in _relief.traversals(structure, settings.get("engine", "cpu")):
            start = time.perf_counter()
            intersector = Intersector(scene, structure=structure, traversal=traversal, **settings)
            prepared = time.perf_counter()
            seconds = float("inf")
            for _ in range(repeats):
                begin = time.perf_counter()
                hits = intersector.closest_hits(rays)
                seconds = min(seconds, time.perf_counter() - begin)
            first = hits.t if first is None else first
            table.append({"structure": structure, "traversal": traversal, "prepare_s": prepared - start, "seconds": seconds,
                          "rays_per_second": len(hits) / seconds, "same_hits": float(np.mean(hits.t == first))})
    return table
