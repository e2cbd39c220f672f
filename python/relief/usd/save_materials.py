"""Materials as OpenPBR (MaterialX) and, for programs that do not know it, as UsdPreviewSurface."""
from __future__ import annotations

import relief
from pxr import Gf, Sdf, UsdShade

INPUTS = relief.material_inputs()
ALIASES = {row[key]: row["name"] for row in INPUTS for key in ("alias", "texture_key") if row[key] and row[key] != "emission"}
NUMBERS = tuple(row["name"] for row in INPUTS if row["type"] == "number")
COLORS = tuple(row["name"] for row in INPUTS if row["type"] == "color")
# Where Relief's default is not OpenPBR's, and what the surface for previews takes.
DEFAULTS = {"specular_roughness": 0.5, "base_color": [0.8, 0.8, 0.8]}
PREVIEW = {"base_color": "diffuseColor", "base_metalness": "metallic", "specular_roughness": "roughness", "specular_ior": "ior",
           "coat_weight": "clearcoat", "coat_roughness": "clearcoatRoughness", "geometry_opacity": "opacity",
           "emission_color": "emissiveColor", "geometry_normal": "normal"}
SPACES = {"srgb": "sRGB", "linear": "raw"}


def unify(keys: dict) -> dict:
    """One name for each input, its number and its texture in one: {"file": ..., "factor": ...}."""
    found = dict(DEFAULTS)
    for name, value in keys.items():
        if not name.endswith("_texture"):
            found[ALIASES.get(name, name)] = value
    for name, value in keys.items():
        if name.endswith("_texture"):
            texture = {"file": value} if isinstance(value, str) else dict(value)
            own = ALIASES[name]
            if own != "geometry_normal":
                texture["factor"] = found.get(own, 1.0)
            found[own] = texture
    emission = found.pop("emission", None)
    if emission is not None:
        found["emission_luminance"], found["emission_color"] = 1.0, emission
    return found


class MaterialWriter:
    def __init__(self, writer) -> None:
        self.writer, self.paths = writer, {}

    def write(self, name: str, keys: dict) -> None:
        path = self.writer.make_path("/World/Materials", name)
        material = UsdShade.Material.Define(self.writer.stage, path)
        self.paths[name] = path
        prim = material.GetPrim()
        prim.CreateAttribute("relief:name", Sdf.ValueTypeNames.String, True).Set(name)
        if keys.get("light_group"):
            prim.CreateAttribute("relief:light_group", Sdf.ValueTypeNames.String, True).Set(keys["light_group"])
        surface = self.define(f"{path}/surface", "ND_open_pbr_surface_surfaceshader")
        preview = self.define(f"{path}/preview", "UsdPreviewSurface")
        material.CreateSurfaceOutput("mtlx").ConnectToSource(surface.ConnectableAPI(), "surface")
        material.CreateSurfaceOutput().ConnectToSource(preview.ConnectableAPI(), "surface")
        for key, value in unify(keys).items():
            self.write_input(path, surface, preview, key, value)

    def define(self, path: str, identifier: str) -> UsdShade.Shader:
        shader = UsdShade.Shader.Define(self.writer.stage, path)
        shader.CreateIdAttr(identifier)
        shader.CreateOutput("surface", Sdf.ValueTypeNames.Token)
        return shader

    def write_input(self, path: str, surface, preview, key: str, value) -> None:
        if key == "geometry_thin_walled":
            surface.CreateInput(key, Sdf.ValueTypeNames.Bool).Set(value)
            return
        if key == "geometry_normal":
            self.write_normal(path, surface, preview, value)
            return
        if key not in NUMBERS and key not in COLORS:
            if key != "light_group":
                self.writer.report.add(path, f"{key} is not written")
            return
        is_color = key in COLORS
        kind = Sdf.ValueTypeNames.Color3f if is_color else Sdf.ValueTypeNames.Float
        inputs = [surface.CreateInput(key, kind)]
        if key in PREVIEW:
            inputs.append(preview.CreateInput(PREVIEW[key], kind))
        if isinstance(value, dict):
            texture, output = self.write_texture(f"{path}/{key}", value, is_color)
            for shader_input in inputs:
                shader_input.ConnectToSource(texture.ConnectableAPI(), output)
            return
        for shader_input in inputs:
            shader_input.Set(Gf.Vec3f(*value) if is_color else float(value))

    def write_texture(self, path: str, keys: dict, is_color: bool):
        """(shader, its output) of a texture times a factor."""
        shader = UsdShade.Shader.Define(self.writer.stage, path)
        shader.CreateIdAttr("UsdUVTexture")
        shader.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(self.writer.name_asset(keys["file"]))
        space = keys.get("color_space", "auto" if is_color else "linear")
        shader.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set(SPACES.get(space, "auto"))
        if space not in ("auto", *SPACES):
            set_text(shader, "color_space", space)
        for side in ("wrapS", "wrapT"):
            shader.CreateInput(side, Sdf.ValueTypeNames.Token).Set(keys.get("wrap", "repeat"))
        factor = keys.get("factor", 1.0)
        factor = [factor] * 3 if isinstance(factor, (int, float)) else factor
        if set(factor) != {1}:
            shader.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(*factor, factor[0]))
        if "filter" in keys:
            set_text(shader, "filter", keys["filter"])
        self.write_coordinates(path, shader, keys)
        channel = keys.get("channel", None if is_color else "r")
        if channel == "luminance" or (is_color and channel is not None):
            set_text(shader, "channel", channel)
        output = channel if not is_color and channel in ("r", "g", "b", "a") else "rgb"
        kinds = Sdf.ValueTypeNames.Float3 if output == "rgb" else Sdf.ValueTypeNames.Float
        shader.CreateOutput(output, kinds)
        return shader, output

    def write_coordinates(self, path: str, shader: UsdShade.Shader, keys: dict) -> None:
        reader = UsdShade.Shader.Define(self.writer.stage, f"{path}_st")
        reader.CreateIdAttr("UsdPrimvarReader_float2")
        reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
        last = reader
        last.CreateOutput("result", Sdf.ValueTypeNames.Float2)
        if "uv_scale" in keys or "uv_offset" in keys:
            last = UsdShade.Shader.Define(self.writer.stage, f"{path}_place")
            last.CreateIdAttr("UsdTransform2d")
            last.CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
            last.CreateInput("scale", Sdf.ValueTypeNames.Float2).Set(make_pair(keys.get("uv_scale", 1.0)))
            last.CreateInput("translation", Sdf.ValueTypeNames.Float2).Set(make_pair(keys.get("uv_offset", 0.0)))
            last.CreateOutput("result", Sdf.ValueTypeNames.Float2)
        shader.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(last.ConnectableAPI(), "result")

    def write_normal(self, path: str, surface, preview, value) -> None:
        keys = {"file": value} if isinstance(value, str) else value
        size = keys.get("scale", 1.0)
        sign = -1.0 if keys.get("flip_y") else 1.0
        rest = {key: v for key, v in keys.items() if key not in ("scale", "flip_y")}
        texture, output = self.write_texture(f"{path}/geometry_normal", {**rest, "color_space": "linear"}, True)
        texture.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(2 * size, 2 * sign * size, 2, 1))
        texture.CreateInput("bias", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(-size, -sign * size, -1, 0))
        surface.CreateInput("geometry_normal", Sdf.ValueTypeNames.Float3).ConnectToSource(texture.ConnectableAPI(), output)
        preview.CreateInput("normal", Sdf.ValueTypeNames.Normal3f).ConnectToSource(texture.ConnectableAPI(), output)


def set_text(shader: UsdShade.Shader, name: str, value: str) -> None:
    shader.GetPrim().CreateAttribute(f"relief:{name}", Sdf.ValueTypeNames.String, True).Set(value)


def make_pair(value) -> Gf.Vec2f:
    return Gf.Vec2f(value, value) if isinstance(value, (int, float)) else Gf.Vec2f(*value)
