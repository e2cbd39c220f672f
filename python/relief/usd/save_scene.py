"""Writes a scene as a stage: meshes once, objects as instances of them, and relief: attributes for what USD has no word for.

Scene.save() writes the arrays of a scene into files first; the stage names those files."""
from __future__ import annotations

import json
import os
import re

import numpy as np
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdRender, UsdShade, Vt

import relief

from .context import Report, make_error
from .save_lights import write_camera, write_environment, write_lights
from .save_materials import MaterialWriter

SCHEMES = {"catmark": "catmullClark", "bilinear": "bilinear"}
BOUNDARIES = {"edge-only": "edgeOnly", "edge-and-corner": "edgeAndCorner"}
NO_INDEX = 0xFFFFFFFF
TYPES = {bool: Sdf.ValueTypeNames.Bool, int: Sdf.ValueTypeNames.Double, float: Sdf.ValueTypeNames.Double,
         str: Sdf.ValueTypeNames.String}


class Writer:
    """A stage that is being written, and the scene file that it is written from."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.folder = os.path.splitext(path)[0] + "_files"
        self.report = Report()
        self.stage = create_stage(path)
        self.names: dict = {}

    def name_asset(self, file: str) -> Sdf.AssetPath:
        """A file of the scene folder, relative to the stage."""
        full = os.path.join(self.folder, file)
        return Sdf.AssetPath("./" + os.path.relpath(full, os.path.dirname(os.path.abspath(self.path))).replace(os.sep, "/"))

    def make_path(self, parent: str, name: str) -> str:
        """A path below `parent` that no other name has."""
        base = Tf.MakeValidIdentifier(name) or "_"
        path, number = f"{parent}/{base}", 1
        while path in self.names:
            number += 1
            path = f"{parent}/{base}_{number}"
        self.names[path] = name
        return path


def create_stage(path: str) -> Usd.Stage:
    if os.path.splitext(path)[1] not in (".usda", ".usdc", ".usd"):
        raise make_error("has no ending of USD", path, "usda, usdc and usd are written")
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 1)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/World").GetPrim())
    return stage


def set_attribute(prim: Usd.Prim, name: str, value) -> None:
    """A relief: attribute of the type of its value."""
    if isinstance(value, (list, tuple)):
        kinds = {2: Sdf.ValueTypeNames.Double2, 3: Sdf.ValueTypeNames.Double3}
        kind, value = kinds[len(value)], {2: Gf.Vec2d, 3: Gf.Vec3d}[len(value)](*map(float, value))
    else:
        kind = TYPES[type(value)]
    prim.CreateAttribute(name, kind, True).Set(value)


def read_scene_file(folder: str) -> dict:
    with open(os.path.join(folder, "scene.json"), encoding="utf-8") as file:
        text = file.read()
    return json.loads(re.sub(r"(?m)^\s*//.*$", "", text))


def save_scene(scene: relief.Scene, path: str, report: list | None) -> None:
    writer = Writer(path)
    scene._save_still(writer.folder)
    keys = read_scene_file(writer.folder)
    materials = MaterialWriter(writer)
    for name, material in keys.get("materials", {}).items():
        materials.write(name, material)
    meshes = {name: write_mesh(writer, name, mesh) for name, mesh in keys.get("meshes", {}).items()}
    paths = write_objects(writer, keys, meshes, materials.paths)
    camera = write_camera(writer, keys.get("camera", {}), keys.get("render", {}))
    write_settings(writer, keys.get("render", {}), camera)
    if "environment" in keys:
        write_environment(writer, keys["environment"])
    write_lights(writer, keys.get("lights", []), paths)
    if not writer.stage.GetRootLayer().Export(path):
        raise make_error("cannot be written", path)
    if report is not None:
        report += writer.report.lines()


def write_settings(writer: Writer, keys: dict, camera: str) -> None:
    settings = UsdRender.Settings.Define(writer.stage, "/Render/settings")
    writer.stage.SetMetadata("renderSettingsPrimPath", "/Render/settings")
    if "width" in keys and "height" in keys:
        settings.CreateResolutionAttr(Gf.Vec2i(keys["width"], keys["height"]))
    settings.CreateCameraRel().SetTargets([camera])
    for name in ("spp", "bounces", "seed"):
        if name in keys:
            settings.GetPrim().CreateAttribute(f"relief:{name}", Sdf.ValueTypeNames.UInt, True).Set(keys[name])


def write_mesh(writer: Writer, name: str, keys: dict) -> str:
    """A class with the mesh, which objects refer to; returns its path."""
    arrays = relief.Mesh.load(os.path.join(writer.folder, keys["file"]))
    path = writer.make_path("/Meshes", name)
    writer.stage.CreateClassPrim("/Meshes")
    writer.stage.CreateClassPrim(path)
    mesh = UsdGeom.Mesh.Define(writer.stage, f"{path}/mesh")
    prim = mesh.GetPrim()
    set_attribute(prim, "relief:mesh_name", name)
    positions = np.array(arrays.positions, np.float32)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(positions))
    sizes, corners = np.array(arrays.sizes, np.int32), np.array(arrays.corners, np.int32)
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(sizes))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(corners))
    mesh.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([positions.min(0), positions.max(0)])))
    write_uvs(writer, prim, arrays)
    write_subdivision(mesh, keys.get("subdivision", {}), arrays)
    if "weld" in keys:
        set_attribute(prim, "relief:weld", float(keys["weld"]))
    if arrays.normals is not None and len(arrays.normals):
        normals = UsdGeom.PrimvarsAPI(prim).CreatePrimvar("normals", Sdf.ValueTypeNames.Normal3fArray, UsdGeom.Tokens.faceVarying)
        normals.Set(Vt.Vec3fArray.FromNumpy(np.array(arrays.normals, np.float32)))
        normals.SetIndices(Vt.IntArray.FromNumpy(np.array(arrays.normal_indices, np.int32)))
    return path


def write_uvs(writer: Writer, prim: Usd.Prim, arrays: relief.Mesh) -> None:
    if arrays.uvs is None or len(arrays.uvs) == 0:
        return
    uvs, indices = np.array(arrays.uvs, np.float32), np.array(arrays.uv_indices, np.int64)
    if (indices == NO_INDEX).any():
        writer.report.add(prim, "faces without uvs among others have the uv (0, 0)")
        uvs, indices = np.concatenate([uvs, np.zeros((1, 2), np.float32)]), np.where(indices == NO_INDEX, len(uvs), indices)
    primvar = UsdGeom.PrimvarsAPI(prim).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying)
    primvar.Set(Vt.Vec2fArray.FromNumpy(uvs))
    primvar.SetIndices(Vt.IntArray.FromNumpy(indices.astype(np.int32)))


def write_subdivision(mesh: UsdGeom.Mesh, keys: dict, arrays: relief.Mesh) -> None:
    scheme = SCHEMES.get(keys.get("scheme", "none"), "none")
    mesh.CreateSubdivisionSchemeAttr(scheme)
    if scheme == "none":
        return
    if keys.get("level", "auto") != "auto":
        set_attribute(mesh.GetPrim(), "relief:subdivision:level", int(keys["level"]))
    mesh.CreateInterpolateBoundaryAttr(BOUNDARIES[keys.get("boundary", "edge-and-corner")])
    mesh.CreateFaceVaryingLinearInterpolationAttr("all" if keys.get("uv", "smooth") == "linear" else "cornersPlus1")
    rows = find_creases(keys, arrays)
    edges, corners = rows[rows[:, 0] != rows[:, 1]], rows[rows[:, 0] == rows[:, 1]]
    if len(edges):
        mesh.CreateCreaseIndicesAttr(Vt.IntArray.FromNumpy(edges[:, :2].astype(np.int32).reshape(-1)))
        mesh.CreateCreaseLengthsAttr([2] * len(edges))
        mesh.CreateCreaseSharpnessesAttr(Vt.FloatArray.FromNumpy(edges[:, 2].astype(np.float32)))
    if len(corners):
        mesh.CreateCornerIndicesAttr(Vt.IntArray.FromNumpy(corners[:, 0].astype(np.int32)))
        mesh.CreateCornerSharpnessesAttr(Vt.FloatArray.FromNumpy(corners[:, 2].astype(np.float32)))


def find_creases(keys: dict, arrays: relief.Mesh) -> np.ndarray:
    """Rows of two points and a sharpness: those of the file, and those of the scene file."""
    said = keys.get("creases", True)
    rows = [np.zeros((0, 3))]
    if said is not False and arrays.creases is not None and len(arrays.creases):
        rows.append(read_creases(arrays))
    if isinstance(said, list):
        rows.append(np.array(said, np.float64).reshape(-1, 3))
    return np.concatenate(rows)


def read_creases(arrays: relief.Mesh) -> np.ndarray:
    return np.column_stack([np.array(arrays.creases, np.float64), np.array(arrays.sharpness, np.float64)])


def compute_matrix(transform: dict) -> np.ndarray:
    """Scale, then rotations about x, y and z, then the move; for points as columns."""
    if "matrix" in transform:
        return np.array(transform["matrix"], np.float64).reshape(4, 4)
    matrix = np.eye(4)
    scale = np.broadcast_to(np.array(transform.get("scale", 1.0), np.float64), 3)
    turn = np.eye(3)
    for axis, degrees in enumerate(transform.get("rotate_degrees", (0, 0, 0))):
        angle, (j, k) = np.radians(degrees), ((axis + 1) % 3, (axis + 2) % 3)
        one = np.eye(3)
        one[j, j] = one[k, k] = np.cos(angle)
        one[j, k], one[k, j] = -np.sin(angle), np.sin(angle)
        turn = one @ turn
    matrix[:3, :3] = turn * scale
    matrix[:3, 3] = transform.get("translate", (0, 0, 0))
    return matrix


def write_objects(writer: Writer, keys: dict, meshes: dict, materials: dict) -> dict:
    """Instances of the meshes; returns the paths of each name, for light linking."""
    paths: dict = {}
    UsdGeom.Scope.Define(writer.stage, "/World/Objects")
    for entry in keys.get("objects", []):
        name = entry.get("name") or entry["mesh"]
        path = writer.make_path("/World/Objects", name)
        xform = UsdGeom.Xform.Define(writer.stage, path)
        prim = xform.GetPrim()
        prim.GetReferences().AddInternalReference(meshes[entry["mesh"]])
        prim.SetInstanceable(True)
        set_attribute(prim, "relief:name", name)
        if "transform" in entry:
            matrix = compute_matrix(entry["transform"])
            xform.AddTransformOp().Set(Gf.Matrix4d(*matrix.T.reshape(-1).tolist()))
        if "material" in entry:
            UsdShade.MaterialBindingAPI.Apply(prim).Bind(UsdShade.Material(writer.stage.GetPrimAtPath(materials[entry["material"]])))
        if "displacement" in entry:
            write_displacement(writer, prim, keys["displacements"][entry["displacement"]], entry["displacement"])
        if entry.get("shadow_catcher"):
            set_attribute(prim, "relief:shadow_catcher", True)
        if "instances" in entry:
            writer.report.add(prim, "its instances are not written: it stands once")
        paths.setdefault(name, []).append(path)
    return paths


def write_displacement(writer: Writer, prim: Usd.Prim, keys: dict, name: str) -> None:
    set_attribute(prim, "relief:displacement:name", name)
    for key, value in keys.items():
        if key == "file":
            prim.CreateAttribute("relief:displacement:file", Sdf.ValueTypeNames.Asset, True).Set(writer.name_asset(value))
        else:
            set_attribute(prim, f"relief:displacement:{key}", value)
