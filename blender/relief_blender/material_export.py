"""Materials of Blender as materials and displacements of Relief, each once."""
from typing import NamedTuple

import bpy
import numpy as np
import relief

from . import faults
from .displacement_export import DisplacementReader
from .kept_parts import KeptMaterial
from .node_tree import NotExpressible, Wire, find_output, follow
from .node_values import NodeValues
from .shaders import FALLBACK, Shaders
from .textures import TextureWriter
from .values import Constant, Place, Texels, Textured, make_constant

LAYERED_NUMBERS = ["coat_weight", "coat_roughness", "fuzz_weight", "fuzz_roughness", "base_diffuse_roughness", "roughness"]
COLORS = {row["name"] for row in relief.material_inputs() if row["type"] == "color"}
IORS = {row["alias"] or row["name"] for row in relief.material_inputs() if row["low"] == 1}


class ExportedMaterial(NamedTuple):
    """Names in the scene, the place that the uvs of its meshes are to have, and the uv maps of their further sets, which are
    1, 2 and so on."""
    material: str
    displacement: str | None = None
    base: Place = Place()
    is_tangent: bool = False
    is_world_height: bool = False
    further: tuple = ()
    is_volume_only: bool = False


class MaterialExport:
    """Adds materials to a relief.Scene. What Relief has no keys for goes to the report under their names.

    `sources`: the original bpy.types.Material of each name. `derived`: displacements that are others but for a factor of
    their scale, as (name of the other, factor). `without_normals`: {name: name of the same without its normal map}."""

    def __init__(self, scene, report, kept=None):
        """kept: a KeptParts, where the same materials may come again."""
        self._scene, self._report, self._done, self._kept = scene, report, {}, kept
        self.sources, self.derived, self.without_normals = {}, {}, {}

    def export(self, material):
        """`material` may be None: Blender's grey."""
        key = material.name_full if material else ""
        if key not in self._done:
            with faults.place("material", key):
                self._done[key] = self._take_kept(key) if self._kept and key else None
                if self._done[key] is None:
                    self._done[key] = self._make(material)
            if material is not None:
                self.sources[key] = material.original
        return self._done[key]

    def leave_out_normal_map(self, name):
        """The name of a material of the scene without its normal map, which needs uvs; None: it has no normal map."""
        if "geometry_normal" not in self._scene.materials[name]:
            return None
        if name not in self.without_normals:
            self.without_normals[name] = find_free_name(f"{name} without its normal map")
            self.copy_without_normal_map(name)
        return self.without_normals[name]

    def copy_without_normal_map(self, name):
        keys = {key: value for key, value in self._scene.materials[name].items() if key != "geometry_normal"}
        self._scene.materials[self.without_normals[name]] = relief.Material(keys)

    def _take_kept(self, name):
        """The ExportedMaterial of an export before, or None."""
        kept = self._kept.find_material(name)
        if kept is None:
            return None
        self._scene.materials[name] = kept.keys
        if kept.displacement is not None:
            self._scene.displacements[name] = kept.displacement
        return kept.exported

    def _keep(self, name, exported, texels):
        """Images that are being painted on change without a word."""
        if self._kept and not texels.has_dirty_images():
            self._kept.keep_material(name, KeptMaterial(exported, self._scene.materials[name],
                                                        self._scene.displacements.get(name)))
        return exported

    def _make(self, material):
        if material is None:
            name = find_free_name("default")
            self._scene.materials[name] = relief.Material(base_color=[0.8, 0.8, 0.8])
            return ExportedMaterial(name)
        name = material.name_full

        def report(text):
            self._report.add("material", name, text)
        node_values = NodeValues(report, Texels(report, self._kept.tiles if self._kept else None))
        keys, displacement = self._read(material, node_values, report)
        if keys is None:
            self._scene.materials[name] = relief.Material()
            return ExportedMaterial(name, is_volume_only=True)
        base = displacement.value.place if displacement else self._choose_place(keys)
        base = Place(base.uv_map, base.scale, base.offset)
        if not displacement:
            base = Place(base.uv_map)
        writer = TextureWriter(node_values.texels, report, base)
        self._scene.materials[name] = self._write(keys, writer, report)
        further = tuple(writer.further)
        if displacement is None:
            return self._keep(name, ExportedMaterial(name, None, base, further=further), node_values.texels)
        self._scene.displacements[name] = displacement.write(node_values.texels)
        return self._keep(name, ExportedMaterial(name, name, base, displacement.is_tangent, displacement.is_world_height,
                                                 further), node_values.texels)

    def _read(self, material, node_values, report):
        """(keys of the surface, displacement or None). Without keys there is a volume and no surface: nothing is seen of it."""
        tree = material.node_tree
        is_by_nodes = tree is not None and (material.use_nodes or not hasattr(material, "use_nodes"))
        if not is_by_nodes:
            return {"base_color": make_constant(list(material.diffuse_color)), "metallic": make_constant(material.metallic),
                    "roughness": make_constant(material.roughness)}, None
        output = find_output(tree)
        if output is None:
            report("it has no output node: it is grey")
            return dict(FALLBACK), None
        if output.inputs["Volume"].is_linked:
            report("its volume is not taken over")
            if is_unlinked(output.inputs["Surface"]) and not is_unlinked(output.inputs["Volume"]):
                return None, None
        try:
            keys = Shaders(node_values, report).surface(Wire(output.inputs["Surface"]))
        except NotExpressible as fault:
            report(f"{fault}: it is grey")
            keys = dict(FALLBACK)
        return keys, DisplacementReader(material, node_values, report).read(output)

    @staticmethod
    def _choose_place(keys):
        """The place of the normal map, which lies on the uvs of the mesh alone, else of the first texture, colours first."""
        found = [v for k, v in sorted(keys.items(), key=lambda item: item[0] != "base_color") if isinstance(v, Textured)]
        if "normal" in keys:
            found.insert(0, keys["normal"][0])
        return found[0].place if found else Place()

    def _write(self, keys, writer, report):
        keys = resolve_conflicts(dict(keys), report, writer.mean)
        result = relief.Material()
        for key, value in keys.items():
            label = key.replace("_", " ")
            if key == "normal":
                result["geometry_normal"] = writer.normal(*value)
            elif key in IORS:
                result[key] = writer.number(value, label, 1.0, 1e6)
            elif key == "emission":
                result[key] = writer.color(value, label, 0.0, np.inf)
            elif key in COLORS:
                result[key] = writer.color(value, label)
            else:
                result["geometry_opacity" if key == "opacity" else key] = writer.number(value, label)
        return result


def is_unlinked(socket):
    """Whether no node feeds a socket, past reroutes, muted nodes and groups."""
    try:
        return follow(Wire(socket)).node is None
    except NotExpressible:
        return True


def find_free_name(stem):
    """A name that no material of the file has."""
    taken, name, number = {material.name_full for material in bpy.data.materials}, stem, 1
    while name in taken:
        number += 1
        name = f"{stem} {number}"
    return name


def resolve_conflicts(keys, report, find_mean):
    """What Relief refuses together: the rarer part goes, and is named."""
    opacity = keys.get("opacity", make_constant(1))
    if isinstance(opacity, Constant) and opacity.number == 1:
        keys.pop("opacity", None)
    elif "emission" in keys:
        report("a cut-out does not emit: its emission is left out")
        keys.pop("emission")
    if "transmission_weight" in keys and ("coat_weight" in keys or "fuzz_weight" in keys):
        report("glass has no coat or sheen: they are left out")
        keys = {k: v for k, v in keys.items() if not k.startswith(("coat_", "fuzz_"))}
    textured = [key for key in LAYERED_NUMBERS if isinstance(keys.get(key), Textured)]
    for key in textured[4:]:
        report(f"{key.replace('_', ' ')}: the fifth texture of its layers is its mean")
        keys[key] = find_mean(keys[key])
    return keys
