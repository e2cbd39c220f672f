"""The prims of a stage with their places: visibility, purposes, transforms, instances and point instancers."""
from __future__ import annotations

import dataclasses

import numpy as np
from pxr import Usd, UsdGeom, UsdLux

from .context import Context, to_matrix

ALIVE = Usd.PrimIsActive & Usd.PrimIsLoaded & ~Usd.PrimIsAbstract
MAX_DEPTH = 16  # of instancers in prototypes of instancers


@dataclasses.dataclass
class Item:
    """A prim and where it stands: one matrix or, below a point instancer, a stack of them."""
    prim: Usd.Prim
    matrices: np.ndarray  # (4, 4) or (K, 4, 4), world from object
    instancer: Usd.Prim | None = None

    def is_light(self) -> bool:
        return self.prim.HasAPI(UsdLux.LightAPI)


@dataclasses.dataclass
class Place:
    """A prim to look at, below what has been looked at."""
    prim: Usd.Prim
    matrix: np.ndarray
    purpose: str


def compute_local(context: Context, prim: Usd.Prim):
    """(matrix, whether it stands for itself): the transform of a prim relative to its parent."""
    if not prim.IsA(UsdGeom.Xformable):
        return np.eye(4), False
    xformable = UsdGeom.Xformable(prim)
    return to_matrix(xformable.GetLocalTransformation(context.time)), xformable.GetResetXformStack()


def is_hidden(context: Context, prim: Usd.Prim) -> bool:
    if not prim.IsA(UsdGeom.Imageable):
        return False
    return context.get(UsdGeom.Imageable(prim).GetVisibilityAttr()) == UsdGeom.Tokens.invisible


def find_purpose(prim: Usd.Prim, inherited: str) -> str:
    if not prim.IsA(UsdGeom.Imageable):
        return inherited
    attribute = UsdGeom.Imageable(prim).GetPurposeAttr()
    return attribute.Get() if attribute.HasAuthoredValue() else inherited


def walk(context: Context, root: Usd.Prim, base: np.ndarray, depth: int = 0):
    """Items of all visible prims below and at `root`, in the order of the stage; `base` places the parent of `root`."""
    predicate = Usd.TraverseInstanceProxies(ALIVE & Usd.PrimIsDefined if depth == 0 else ALIVE)
    stack = [Place(root, base, UsdGeom.Tokens.default_)]
    while stack:
        place = stack.pop()
        prim = place.prim
        with context.reading(prim):
            is_seen, (local, is_reset) = not is_hidden(context, prim), compute_local(context, prim)
        if not is_seen:
            if context.range is not None and UsdGeom.Imageable(prim).GetVisibilityAttr().ValueMightBeTimeVarying():
                context.report.add(prim, "visibility changes with time: it is hidden as at the frame")
            continue
        purpose = find_purpose(prim, place.purpose)
        matrix = (base if is_reset else place.matrix) @ local
        is_taken = purpose in context.options.purposes
        if prim.IsA(UsdGeom.PointInstancer):
            if is_taken:
                yield from expand_instancer(context, prim, matrix, depth)
            continue
        if is_taken and prim.GetPath() != prim.GetPath().absoluteRootPath:
            yield Item(prim, matrix)
        children = prim.GetFilteredChildren(predicate)
        stack += [Place(child, matrix, purpose) for child in reversed(children)]


def expand_instancer(context: Context, prim: Usd.Prim, matrix: np.ndarray, depth: int):
    """Items of the prototypes of a point instancer, at all of their places at once."""
    instancer = UsdGeom.PointInstancer(prim)
    targets = instancer.GetPrototypesRel().GetForwardedTargets()
    indices = np.array(context.get(instancer.GetProtoIndicesAttr(), []), np.int64)
    if depth >= MAX_DEPTH:
        context.report.add(prim, "instancers within instancers end here")
        return
    if len(indices) == 0:
        return
    places = instancer.ComputeInstanceTransformsAtTime(context.time, context.time, UsdGeom.PointInstancer.ExcludeProtoXform,
                                                       UsdGeom.PointInstancer.IgnoreMask)
    if not places or len(places) != len(indices):
        context.fail(prim, f"has {len(indices)} protoIndices and other numbers of positions, scales or orientations")
    places = np.array(places, np.float64).transpose(0, 2, 1)
    mask = instancer.ComputeMaskAtTime(context.time)
    is_seen = np.array(mask, bool) if len(mask) else np.ones(len(indices), bool)
    for number, target in enumerate(targets):
        chosen = matrix @ places[is_seen & (indices == number)]
        prototype = context.stage.GetPrimAtPath(target)
        if len(chosen) == 0:
            continue
        if not prototype:
            context.report.add(prim, f"there is no prototype {target}")
            continue
        for item in walk(context, prototype, np.eye(4), depth + 1):
            inner = item.matrices.reshape(-1, 4, 4)
            yield Item(item.prim, (chosen[:, None] @ inner[None]).reshape(-1, 4, 4), prim)
    if indices.min() < 0 or indices.max() >= len(targets):
        context.report.add(prim, f"some protoIndices are not among its {len(targets)} prototypes")
