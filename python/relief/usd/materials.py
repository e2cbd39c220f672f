"""Materials: which shader of a UsdShade material is read, and by which reader."""
from __future__ import annotations

import dataclasses

import numpy as np
from pxr import Usd, UsdShade

import relief

from .context import Context
from .displacements import read_displacement
from .material_keys import KeySetter
from .openpbr import ANISOTROPY, read_open_pbr, read_standard_surface
from .preview_surface import read_preview_surface
from .shading import Network

SURFACES = {"UsdPreviewSurface": read_preview_surface, "ND_UsdPreviewSurface_surfaceshader": read_preview_surface,
            "ND_open_pbr_surface_surfaceshader": read_open_pbr,
            "ND_standard_surface_surfaceshader": read_standard_surface}


@dataclasses.dataclass
class ReadMaterial:
    name: str
    uvs: str | None           # the uvs of its displacement and of textures without a uv_set
    displacement: dict | None # keys of the scene file
    emits: bool
    needs_uvs: bool           # it has a normal map or is anisotropic
    further_uvs: tuple = ()   # the uvs of its textures whose uv_set is 1, 2 and so on


def needs_uvs(keys: dict) -> bool:
    return "geometry_normal" in keys or any(keys.get(name) for name in ANISOTROPY)


class MaterialReader:
    """Materials of a stage, each read once."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.found: dict = {}
        self.names: dict = {}

    def read_bound(self, prim: Usd.Prim) -> ReadMaterial | None:
        """The material bound to a prim, or one of its displayColor; None where there is neither."""
        material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial(UsdShade.Tokens.full)
        if material:
            return self.read(material.GetPrim())
        if prim.HasRelationship("material:binding") and prim.GetRelationship("material:binding").GetTargets():
            self.context.report.add(prim, "the material that it names is not there")
        return self.read_display_color(prim)

    def read(self, prim: Usd.Prim) -> ReadMaterial:
        own = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        key = str(own.GetPath())
        if key not in self.found:
            with self.context.reading(prim):
                self.found[key] = self.read_new(prim)
        return self.found[key]

    def make_name(self, wanted: str) -> str:
        name, number = wanted, 1
        while name in self.context.scene.materials:
            number += 1
            name = f"{wanted}_{number}"
        return name

    def read_new(self, prim: Usd.Prim) -> ReadMaterial:
        material, network = UsdShade.Material(prim), Network(self.context, prim)
        noted = prim.GetAttribute("relief:name")
        name = self.make_name(noted.Get() if noted and noted.Get() else prim.GetName())
        setter = KeySetter(network)
        shader, reader = self.find_surface(material)
        if shader is None:
            network.note("has no surface that is known: it is grey")
        else:
            reader(network, shader, setter)
        displacement = read_displacement(network, material)
        self.finish(prim, setter)
        uvs, further_uvs = setter.number_uv_sets(displacement.pop("uvs", None) if displacement is not None else None)
        self.context.scene.materials[name] = relief.Material(**setter.keys)
        if material.ComputeVolumeSource()[0]:
            network.note("its volume is not taken over")
        return ReadMaterial(name, uvs, displacement, setter.emits(), needs_uvs(setter.keys), further_uvs)

    def find_surface(self, material: UsdShade.Material):
        """MaterialX's surface before the one for all renderers."""
        others = []
        for render_context in ("mtlx", ""):
            shader = material.ComputeSurfaceSource(render_context)[0]
            if not shader:
                continue
            identifier = shader.GetIdAttr().Get()
            if identifier in SURFACES:
                return shader, SURFACES[identifier]
            others.append(identifier or shader.GetPrim().GetName())
        for identifier in others:
            self.context.report.add(material.GetPrim(), f"surface {identifier} is not taken over")
        return None, None

    def finish(self, prim: Usd.Prim, setter: KeySetter) -> None:
        """What Relief refuses together."""
        keys = setter.keys
        if setter.emits() and "geometry_opacity" in keys:
            setter.network.note("emits light and has an opacity: the opacity is left out")
            del keys["geometry_opacity"]
        if keys.get("transmission_weight"):
            for name in ("coat_weight", "fuzz_weight"):
                if keys.pop(name, 0):
                    setter.network.note(f"is glass and has a {name}: that is left out")
            if isinstance(keys.get("specular_weight"), dict):
                setter.network.note("texture of specular_weight of glass is left out")
                del keys["specular_weight"]
            if isinstance(keys.get("transmission_color"), dict) and keys.get("transmission_depth"):
                setter.network.note("texture of transmission_color inside of a body is left out")
                del keys["transmission_color"]
        group = prim.GetAttribute("relief:light_group")
        if group and group.Get():
            keys["light_group"] = group.Get()

    def read_display_color(self, prim: Usd.Prim) -> ReadMaterial | None:
        """One material for each colour; where a mesh has several, of their mean."""
        from pxr import UsdGeom

        found = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
        values = np.array(found.Get(self.context.time) if found and found.HasValue() else [], np.float64).reshape(-1, 3)
        if not np.isfinite(values).all():
            self.context.report.add(prim, "displayColor is not finite and is left out")
            return None
        if len(values) == 0:
            return None
        if len(values) > 1 and np.ptp(values, axis=0).max() > 1e-6:
            self.context.report.add(prim, "displayColor varies: its mean is used")
        color = tuple(float(c) for c in np.clip(values.mean(0), 0, 1))
        if color not in self.found:
            name = self.make_name("displayColor")
            self.context.scene.materials[name] = relief.Material(base_color=list(color))
            self.found[color] = ReadMaterial(name, None, None, False, False)
        return self.found[color]
