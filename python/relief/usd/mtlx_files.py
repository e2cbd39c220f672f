"""MaterialX files that a stage refers to, which usd-core cannot open: their materials as UsdShade, in the session layer."""
from __future__ import annotations

import os
import re
import xml.etree.ElementTree as tree

from pxr import Gf, Sdf, Tf, Usd, UsdShade

from .context import Context

TYPES = {"float": Sdf.ValueTypeNames.Float, "integer": Sdf.ValueTypeNames.Int, "boolean": Sdf.ValueTypeNames.Bool,
         "color3": Sdf.ValueTypeNames.Color3f, "color4": Sdf.ValueTypeNames.Color4f, "vector2": Sdf.ValueTypeNames.Float2,
         "vector3": Sdf.ValueTypeNames.Float3, "vector4": Sdf.ValueTypeNames.Float4, "string": Sdf.ValueTypeNames.String,
         "filename": Sdf.ValueTypeNames.Asset}
VECTORS = {2: Gf.Vec2f, 3: Gf.Vec3f, 4: Gf.Vec4f}
COUNTS = {"color3": 3, "color4": 4, "vector2": 2, "vector3": 3, "vector4": 4}
ROOT = "/MaterialX"
MAX_DEPTH = 32


class Document:
    """One file; each material gets its nodes below itself."""

    def __init__(self, path: str) -> None:
        self.root = tree.parse(path).getroot()
        self.folder = os.path.dirname(path)
        self.stage = Usd.Stage.CreateInMemory()
        self.stage.SetDefaultPrim(self.stage.DefinePrim(ROOT, "Scope"))
        self.stage.DefinePrim(f"{ROOT}/Materials", "Scope")
        for element in self.root.findall("surfacematerial"):
            self.add_material(element)

    def find(self, scope, name: str | None):
        """A node of a graph, or of the file."""
        return next((e for e in scope if e.get("name") == name and e.tag not in ("input", "output")), None)

    def add_material(self, element) -> None:
        path = f"{ROOT}/Materials/{element.get('name')}"
        material = UsdShade.Material.Define(self.stage, path)
        for entry in element.findall("input"):
            node = self.find(self.root, entry.get("nodename"))
            if node is None:
                continue
            shader = self.add_node(path, self.root, node, 0)
            output = shader.CreateOutput("out", Sdf.ValueTypeNames.Token)
            if entry.get("type") == "surfaceshader":
                material.CreateSurfaceOutput("mtlx").ConnectToSource(output)
            elif entry.get("type") == "displacementshader":
                material.CreateDisplacementOutput("mtlx").ConnectToSource(output)

    def add_node(self, material: str, scope, node, depth: int) -> UsdShade.Shader:
        graph = "" if scope is self.root else f"{scope.get('name')}_"
        path = f"{material}/{graph}{node.get('name')}"
        if self.stage.GetPrimAtPath(path):
            return UsdShade.Shader(self.stage.GetPrimAtPath(path))
        shader = UsdShade.Shader.Define(self.stage, path)
        kind = node.get("type")
        if node.tag == "displacement":
            kind = next((e.get("type") for e in node.findall("input") if e.get("name") == "displacement"), "float")
        shader.CreateIdAttr(f"ND_{node.tag}_{kind}")
        if depth < MAX_DEPTH:
            for entry in node.findall("input"):
                self.add_input(material, scope, shader, entry, depth)
        return shader

    def add_input(self, material: str, scope, shader: UsdShade.Shader, entry, depth: int) -> None:
        name, kind = entry.get("name"), TYPES.get(entry.get("type"))
        if kind is None:
            return
        if entry.get("interfacename"):
            outer = next((e for e in scope.findall("input") if e.get("name") == entry.get("interfacename")), None)
            if outer is not None:
                outer = dict(outer.attrib, name=name)
                self.add_input(material, self.root, shader, tree.Element("input", outer), depth)
            return
        source_scope, node, output = self.find_source(scope, entry)
        if node is not None:
            source = self.add_node(material, source_scope, node, depth + 1)
            shader.CreateInput(name, kind).ConnectToSource(source.CreateOutput(output or "out", kind))
        elif entry.get("value") is not None:
            attribute = shader.CreateInput(name, kind)
            attribute.Set(self.read_value(scope, entry))
            space = entry.get("colorspace") or (self.root.get("colorspace") if "color" in entry.get("type") else None)
            if space:
                attribute.GetAttr().SetColorSpace(space)

    def find_source(self, scope, entry) -> tuple:
        """(scope, node, its output) that feeds an input."""
        if entry.get("nodegraph"):
            graph = next((e for e in self.root.findall("nodegraph") if e.get("name") == entry.get("nodegraph")), None)
            outputs = [] if graph is None else graph.findall("output")
            output = next((e for e in outputs if entry.get("output") in (None, e.get("name"))), None)
            if output is None:
                return scope, None, None
            return graph, self.find(graph, output.get("nodename")), output.get("output")
        if entry.get("nodename"):
            return scope, self.find(scope, entry.get("nodename")), entry.get("output")
        return scope, None, None

    def read_value(self, scope, entry):
        text, kind = entry.get("value"), entry.get("type")
        if kind == "filename":
            prefix = entry.get("fileprefix") or scope.get("fileprefix") or self.root.get("fileprefix") or ""
            return Sdf.AssetPath(os.path.normpath(os.path.join(self.folder, prefix + text)))
        if kind == "string":
            return text
        if kind == "boolean":
            return text == "true"
        try:
            if kind == "integer":
                return int(text)
            numbers = [float(part) for part in re.split(r"[,\s]+", text.strip())]
        except ValueError:
            numbers = []
        if len(numbers) != COUNTS.get(kind, 1):
            raise ValueError(f"input {entry.get('name')} of type {kind} has the value {text!r}")
        return numbers[0] if len(numbers) == 1 else VECTORS[len(numbers)](*numbers)


def find_references(prim: Usd.Prim) -> list:
    """(file, path in it) of the MaterialX files that a prim refers to."""
    found = []
    for spec in prim.GetPrimStack():
        for item in spec.referenceList.GetAddedOrExplicitItems():
            if item.assetPath.endswith(".mtlx"):
                found.append((spec.layer.ComputeAbsolutePath(item.assetPath), item.primPath))
    return found


def add_files(context: Context, paths: list) -> set:
    """Reads what the prims at `paths` refer to; returns the names of the files that are now there."""
    stage, documents, read = context.stage, {}, set()
    for path in paths:
        prim = stage.GetPrimAtPath(path)
        for file, inner in find_references(prim) if prim and not prim.IsInstanceProxy() else []:
            if file not in documents:
                try:
                    documents[file] = Document(file)
                except (OSError, ValueError, KeyError, tree.ParseError, Tf.ErrorException) as error:
                    context.report.add(prim, f"{os.path.basename(file)}: {' '.join(str(error).split())}")
                    documents[file] = None
            if documents[file] is None:
                continue
            with Usd.EditContext(stage, stage.GetSessionLayer()):
                prim.GetReferences().AddReference(documents[file].stage.GetRootLayer().identifier, inner or Sdf.Path(ROOT))
            read.add(os.path.basename(file))
    context.documents = list(documents.values())  # layers last as long as they are held
    return read
