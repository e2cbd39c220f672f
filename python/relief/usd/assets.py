"""Files that a stage names: where they lie, those of usdz packages and tiles included."""
from __future__ import annotations

import os
import struct

from pxr import Ar, Usd, UsdShade

from .context import Context

TOKENS = ("<UDIM>", "<UVTILE>", "<uvtile>", "<udim>")


def find_layer(attribute: Usd.Attribute, time: Usd.TimeCode):
    """The layer whose opinion the attribute has: file names are relative to it."""
    stack = attribute.GetPropertyStack(time)
    return next((spec.layer for spec in stack if spec.default is not None or spec.HasInfo("timeSamples")),
                attribute.GetStage().GetRootLayer())


def unpack(context: Context, resolved: str, written_as: str) -> str | None:
    """Writes a file of a usdz package into the folder of the scene; returns where it lies."""
    asset = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(resolved))
    if asset is None:
        return None
    path = os.path.join(context.get_folder(), os.path.basename(written_as))
    with asset:
        data = bytes(asset.GetBuffer())
    number = 0
    stem, ending = os.path.splitext(path)
    while os.path.exists(path) and not is_same_file(path, data):
        number += 1
        path = f"{stem}_{number}{ending}"
    with open(path, "wb") as file:
        file.write(data)
    return path


def is_same_file(path: str, data: bytes) -> bool:
    with open(path, "rb") as file:
        return file.read() == data


def find_inner_name(resolved: str) -> str:
    return Ar.SplitPackageRelativePathInner(resolved)[1]


def resolve_tiles(context: Context, attribute: Usd.Attribute, path: str) -> str | None:
    layer = find_layer(attribute, context.time)
    tiles = UsdShade.UdimUtils.ResolveUdimTilePaths(path, layer)
    if not tiles:
        return None
    if not Ar.IsPackageRelativePath(str(tiles[0][0])):
        return str(UsdShade.UdimUtils.ResolveUdimPath(path, layer))
    for resolved, number in tiles:
        resolved = str(resolved)
        unpack(context, resolved, find_inner_name(resolved))
    return os.path.join(context.get_folder(), os.path.basename(path))


def resolve_other_tiles(context: Context, attribute: Usd.Attribute, path: str) -> str:
    """Tokens that USD does not know: the name beside its layer."""
    layer = find_layer(attribute, context.time)
    return os.path.normpath(os.path.join(os.path.dirname(layer.realPath), path))


def resolve_asset(context: Context, attribute: Usd.Attribute) -> str | None:
    """The file that an attribute names, on disk, with its token where it has tiles; None where there is none."""
    value = context.get(attribute)
    path = getattr(value, "path", value)
    if not path:
        return None
    if "<UDIM>" in path:
        return resolve_tiles(context, attribute, path)
    if any(token in path for token in TOKENS):
        return resolve_other_tiles(context, attribute, path)
    resolved = getattr(value, "resolvedPath", "") or str(Ar.GetResolver().Resolve(path))
    if not resolved:
        return None
    if Ar.IsPackageRelativePath(resolved):
        return unpack(context, resolved, find_inner_name(resolved))
    return resolved if os.path.exists(resolved) else None


def has_alpha(path: str) -> bool:
    """False where the header of a PNG, JPEG or HDR file says that it has no alpha; True where that is not known."""
    try:
        with open(path, "rb") as file:
            head = file.read(64 * 1024)
    except OSError:
        return True
    if head[:8] == b"\x89PNG\r\n\x1a\n" and len(head) > 26:
        return head[25] in (4, 6) or b"tRNS" in head
    if head[:2] == b"\xff\xd8" or head[:2] == b"#?":
        return False
    if head[:4] == struct.pack("<I", 20000630):
        begin = head.find(b"channels\0chlist\0")
        return begin < 0 or b"\0A\0" in b"\0" + head[begin + 20:begin + 400]
    return True
