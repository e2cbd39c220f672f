"""Stages for the tests of relief.usd, made with USD's own interface, and small pictures for them."""
import os
import struct
import zlib

import numpy as np

try:
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt
except ImportError:
    Usd = None

SQUARE = [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)]  # seen from above counter-clockwise


def write_png(path, array):
    """(H, W, 3 or 4) of uint8."""
    height, width, channels = array.shape
    rows = b"".join(b"\0" + array[row].tobytes() for row in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def make_picture(seed=1, channels=3, size=8):
    return np.random.default_rng(seed).integers(0, 256, (size, size, channels), dtype=np.uint8)


def create(path, up="Y", unit=1.0):
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, up)
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    return stage


def add_square(stage, path, scheme="none", uvs=True):
    """Two units wide at y = 0, its normal upwards."""
    return add_mesh(stage, path, SQUARE, [4], [0, 1, 2, 3], scheme, [(0, 0), (1, 0), (1, 1), (0, 1)] if uvs else None)


def add_mesh(stage, path, points, sizes, corners, scheme="none", uvs=None):
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(Vt.Vec3fArray([Gf.Vec3f(*map(float, p)) for p in points]))
    mesh.CreateFaceVertexCountsAttr(sizes)
    mesh.CreateFaceVertexIndicesAttr(corners)
    mesh.CreateSubdivisionSchemeAttr(scheme)
    if uvs is not None:
        add_uvs(mesh, uvs, "faceVarying" if len(uvs) == len(corners) else "vertex")
    return mesh


def add_uvs(mesh, uvs, interpolation, indices=None, name="st"):
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(name, Sdf.ValueTypeNames.TexCoord2fArray, interpolation)
    primvar.Set(Vt.Vec2fArray([Gf.Vec2f(*map(float, uv)) for uv in uvs]))
    if indices is not None:
        primvar.SetIndices(indices)


def add_material(stage, path, identifier="UsdPreviewSurface", context="", **inputs):
    """A material of one shader; its inputs are constants, or pairs of a shader and an output."""
    material = UsdShade.Material.Define(stage, path)
    shader = UsdShade.Shader.Define(stage, f"{path}/surface")
    shader.CreateIdAttr(identifier)
    output = shader.CreateOutput("surface" if identifier != "ND_displacement_vector3" else "out", Sdf.ValueTypeNames.Token)
    material.CreateSurfaceOutput(context).ConnectToSource(output)
    for name, value in inputs.items():
        set_input(shader, name, value)
    return material


def set_input(shader, name, value):
    if isinstance(value, tuple) and isinstance(value[0], UsdShade.Shader):
        kind = Sdf.ValueTypeNames.Float if value[1] in ("r", "g", "b", "a") else Sdf.ValueTypeNames.Float3
        source = value[0].CreateOutput(value[1], kind)
        shader.CreateInput(name, kind).ConnectToSource(source)
        return
    kinds = {bool: Sdf.ValueTypeNames.Bool, int: Sdf.ValueTypeNames.Int, float: Sdf.ValueTypeNames.Float, str: Sdf.ValueTypeNames.Token}
    if isinstance(value, tuple):
        shader.CreateInput(name, {2: Sdf.ValueTypeNames.Float2, 3: Sdf.ValueTypeNames.Color3f, 4: Sdf.ValueTypeNames.Float4}[len(value)]).Set(
            {2: Gf.Vec2f, 3: Gf.Vec3f, 4: Gf.Vec4f}[len(value)](*value))
    elif isinstance(value, Sdf.AssetPath):
        shader.CreateInput(name, Sdf.ValueTypeNames.Asset).Set(value)
    else:
        shader.CreateInput(name, kinds[type(value)]).Set(value)


def add_texture(stage, path, file, identifier="UsdUVTexture", **inputs):
    shader = UsdShade.Shader.Define(stage, path)
    shader.CreateIdAttr(identifier)
    set_input(shader, "file", Sdf.AssetPath(file))
    for name, value in inputs.items():
        set_input(shader, name, value)
    return shader


def bind(mesh, material):
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
