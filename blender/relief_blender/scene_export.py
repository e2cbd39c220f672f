"""A depsgraph of Blender as a relief.Scene: objects and instances, materials, lights, world. Not the camera."""
from typing import NamedTuple

import numpy as np
import relief

from . import axes, faults
from .lights_export import export_light, link_light
from .material_export import MaterialExport
from .mesh_export import MeshExport
from .mesh_repair import FARTHEST
from .world_export import export_world

MESH_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
SILENT_TYPES = {"CAMERA", "ARMATURE", "LATTICE", "EMPTY", "SPEAKER", "LIGHT_PROBE"}


class Instance(NamedTuple):
    """What became of an instance: entries of objects and lights of the scene."""
    objects: list
    lights: list


def identify(instance):
    """What a DepsgraphObjectInstance is known by from one time to another."""
    name = instance.object.original.name_full
    if not instance.is_instance:
        return name, "", ()
    return name, instance.parent.original.name_full, tuple(instance.persistent_id)


def is_made_by_nodes(instance):
    """Geometry nodes make instances of meshes that are no object's own."""
    return instance.is_instance and instance.parent.original == instance.object.original


class SceneExport:
    """`scene` is the relief.Scene, filled by run()."""

    def __init__(self, depsgraph, report, kept=None):
        """kept: a KeptParts, where the same scene may come again."""
        self.scene = relief.Scene()
        self.instances = {}  # Instance by identify()
        self.materials = MaterialExport(self.scene, report, kept)
        self._depsgraph, self._report = depsgraph, report
        self._meshes = MeshExport(self.scene, self.materials, depsgraph, report, kept)
        self._has_catchers = depsgraph.scene.render.film_transparent
        self._light_objects = []
        self._names = {}  # what links call objects and instancers: names of objects of the scene

    def run(self):
        for instance in self._depsgraph.object_instances:
            if instance.show_self:
                with faults.place("object", instance.object.original.name_full):
                    self._add(instance)
        for light, light_object in zip(self.scene.lights, self._light_objects):
            link_light(light, light_object, self._names)
        with faults.place("world", ""):
            self.scene.environment = export_world(self._depsgraph, self._report)
        self._report_render()
        return self.scene

    def _add(self, instance):
        kind = instance.object.type
        if kind in MESH_TYPES:
            self._add_object(instance)
        elif kind == "LIGHT":
            self._add_light(instance)
        elif kind not in SILENT_TYPES:
            self._report.add("object", instance.object.original.name_full, f"{kind.lower()} objects are not taken over")

    def _report_render(self):
        render = self._depsgraph.scene.render
        if render.use_freestyle:
            self._report.add("scene", "", "Freestyle is left out")
        exposure = getattr(getattr(self._depsgraph.scene, "cycles", None), "film_exposure", 1.0)
        if exposure != 1:
            self._report.add("scene", "", f"Film > Exposure {exposure:g} of Cycles is left out: Color Management > Exposure "
                             f"{np.log2(max(exposure, 1e-10)):.3g} does the same to what is shown")

    def _add_light(self, instance):
        light = export_light(instance.object, instance.matrix_world, self._report)
        if light is None:
            return
        self.scene.lights.append(light)
        self._light_objects.append(instance.object.original)
        self.instances[identify(instance)] = Instance([], [light])

    def _is_shown(self, instance):
        """Whether the camera sees an object; what it would be to other rays is named where it differs."""
        evaluated, layer = instance.object, self._depsgraph.view_layer
        name = evaluated.original.name_full
        owner = instance.parent.original if instance.is_instance else evaluated.original
        is_holdout = owner.holdout_get(view_layer=layer)
        if owner.indirect_only_get(view_layer=layer) and not is_holdout:
            self._report.add("object", name, "its collection is Indirect Only: it is left out, its shadows and reflections too")
            return False
        if evaluated.is_holdout or is_holdout:
            self._report.add("object", name, "holdout is left out: it is seen")
        if not evaluated.visible_camera:
            self._report.add("object", name, "the camera does not see it: it is left out, its shadows and reflections too")
            return False
        flags = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_shadow")
        if not all(getattr(evaluated, flag) for flag in flags):
            self._report.add("object", name, "ray visibility is left out: all rays see it")
        links = evaluated.original.light_linking
        if links.receiver_collection is not None or links.blocker_collection is not None:
            self._report.add("object", name, "light linking of what emits is left out: that of lights alone is taken over")
        for system in evaluated.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self._report.add("object", name, "hair is not taken over")
        return True

    def _add_object(self, instance):
        evaluated = instance.object
        if not self._is_shown(instance):
            return
        matrix = axes.convert_matrix(instance.matrix_world)
        if not np.all(np.abs(matrix) < FARTHEST):  # NaN is not
            self._report.add("object", evaluated.original.name_full, "its transform is not finite: it is left out")
            return
        if abs(np.linalg.det(matrix[:3, :3])) < 1e-30:
            self._report.add("object", evaluated.original.name_full, "it has no volume by its scale: it is left out")
            return
        entries = []
        for part in self._meshes.export(evaluated, is_made_by_nodes(instance)):
            entry = {"name": evaluated.original.name_full, "mesh": part.mesh, "material": part.material,
                     "transform": {"matrix": matrix.reshape(-1).tolist()}}
            if part.displacement is not None:
                entry["displacement"] = self._scale_displacement(part, matrix, evaluated)
            if evaluated.is_shadow_catcher and self._has_catchers:
                entry["shadow_catcher"] = True
            entries.append(entry)
        self.scene.objects += entries
        if entries:
            for known in {evaluated.original, instance.parent.original if instance.is_instance else evaluated.original}:
                self._names.setdefault(known.name_full, {})[entries[0]["name"]] = None
        self.instances[identify(instance)] = Instance(entries, [])

    def _scale_displacement(self, part, matrix, evaluated):
        """Heights in the world's unit, on an object that is scaled: a displacement of its own for each scale."""
        scales = axes.find_axis_scale(matrix)
        if not part.is_world_height or np.allclose(scales, 1, atol=1e-4):
            return part.displacement
        if np.ptp(scales) > 1e-3 * scales.max():
            self._report.add("object", evaluated.original.name_full, "heights in world space take the mean of its scale")
        name = f"{part.displacement} by {float(np.mean(scales)):.6g}"
        if name not in self.scene.displacements:
            scaled = relief.Displacement(**self.scene.displacements[part.displacement])
            scaled["scale"] = scaled["scale"] / float(np.mean(scales))
            self.scene.displacements[name] = scaled
            self.materials.derived[name] = (part.displacement, 1 / float(np.mean(scales)))
        return name
