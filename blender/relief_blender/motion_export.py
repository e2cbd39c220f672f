"""What moves while the shutter is open: a scene that was taken over at its frame gets keys."""
import math
from collections import defaultdict

import numpy as np
import relief

from . import axes, motion_keys
from .lights_export import is_finite, make_light
from .material_export import MaterialExport
from .motion_meshes import MeshMotion
from .report import Report
from .scene_export import MESH_TYPES, identify
from .shutter import Shutter, find_steps, find_times, report_differences
from .stereo import find_cameras, find_views
from .world_export import export_world, find_world

SECTIONS = ("environment", "materials", "displacements", "objects", "lights")
STILL = "motion blur: its transform shears, is mirrored meanwhile or has no volume: it stays still"
COMES = "motion blur: it comes or goes while the shutter is open: it is there or not as at the frame"
NOT_FINITE = "motion blur: its power, colour, size or transform is not finite meanwhile: it stays as at the frame"
NO_PLACE = "motion blur: its transform is not finite meanwhile"
STRAIGHT = "motion blur: its transform shears: its points move straight from one step to the next"


def is_animated(data):
    """Whether keys or drivers move anything of a material, a world or a node group, its groups included."""
    if data is None:
        return False
    if data.animation_data is not None or is_animated(getattr(data, "node_tree", None)):
        return True
    return any(is_animated(getattr(node, "node_tree", None)) for node in getattr(data, "nodes", ()))


def has_keys(part):
    """Whether a value or what it holds has keys."""
    if isinstance(part, dict):
        return "keys" in part or any(has_keys(value) for value in part.values())
    return isinstance(part, list) and any(has_keys(value) for value in part)


def find_owners(instance):
    """Original objects whose settings count for an instance."""
    parent = [instance.parent.original] if instance.is_instance else []
    return [instance.object.original, *parent]


class MotionExport:
    """Moves the frame of a depsgraph through the shutter. `exporter`: a SceneExport that has run; `views`: the View of its
    camera by names of views.

    After run(), `settings` are keywords of relief.render, and `cameras` are those of the scene by names of views."""

    def __init__(self, depsgraph, exporter, views, report):
        self.settings, self._folder = {}, None
        self.cameras = {name: view.camera for name, view in views.items()}
        self._depsgraph, self._exporter, self._at_frame, self._report = depsgraph, exporter, views, report
        self._camera = depsgraph.scene.camera
        self._matrices, self._lights = defaultdict(dict), defaultdict(dict)  # by instance and step
        self._views, self._worlds = {}, {}                                   # by step
        self._materials, self._displacements = defaultdict(dict), defaultdict(dict)  # by name and step
        self._sources = {name: m for name, m in exporter.materials.sources.items() if is_animated(m)}
        self._has_moving_world = is_animated(find_world(depsgraph))

    def run(self, engine):
        """engine: the bpy.types.RenderEngine. Whatever happens, the frame is the old one in the end."""
        scene = self._depsgraph.scene
        times = find_times(self._depsgraph.scene_eval)
        if times is None:
            return
        report_differences(self._depsgraph.scene_eval, self._report)
        self._steps = {identify(instance): find_steps(*find_owners(instance))
                       for instance in self._depsgraph.object_instances}
        self._camera_steps = find_steps(self._camera)
        self._shutter = Shutter(*times, max([2, self._camera_steps, *self._steps.values()]))
        self._meshes = MeshMotion(self._exporter, self._shutter, self._report)
        cameras = find_cameras(engine, scene)
        frame, subframe = scene.frame_current, scene.frame_subframe
        try:
            for step in range(self._shutter.step_count + 1):
                at = self._shutter.find_frame(step)
                engine.frame_set(math.floor(at), at - math.floor(at))
                self._views[step] = find_views(engine, self._depsgraph, Report(), cameras)
                self._look(step)
        finally:
            engine.frame_set(frame, subframe)
        self._write()

    def make_clean_up(self):
        """What removes the files of deforming meshes once they have been rendered, or None. It holds nothing of Blender, which
        a thread that ends late could otherwise not let go of in time."""
        return self._folder.cleanup if self._folder is not None else None

    # At a step

    def _look(self, step):
        if self._has_moving_world:
            self._worlds[step] = export_world(self._depsgraph, Report())
        self._look_at_materials(step)
        self._meshes.begin(step, self._depsgraph)
        for instance in self._depsgraph.object_instances:
            key = identify(instance)
            if key not in self._steps and instance.object.type in {*MESH_TYPES, "LIGHT"}:
                self._report.add("object", key[0], COMES)
            made = self._exporter.instances.get(key)
            if made is None or not self._steps.get(key) or not instance.show_self:
                continue
            matrix = axes.convert_matrix(instance.matrix_world)
            if not np.all(np.isfinite(matrix)):
                self._report.add("object", key[0], NO_PLACE)
                continue
            self._matrices[key][step] = matrix
            if made.lights:
                light = make_light(instance.object.data, instance.matrix_world, lambda text: None)
                self._lights[key][step] = light if is_finite(light) else None
            if made.objects:
                self._meshes.look_at(instance, made.objects)

    def _look_at_materials(self, step):
        if not self._sources:
            return
        scratch = relief.Scene()
        exporter = MaterialExport(scratch, Report())
        for name, source in self._sources.items():
            exported = exporter.export(source.evaluated_get(self._depsgraph))
            self._materials[name][step] = scratch.materials[name]
            self._displacements[name][step] = scratch.displacements.get(name)
            if exported.base != self._exporter.materials.export(source).base:
                self._report.add("material", name, "motion blur: the mapping of its textures stays still")

    # Keys

    def _choose(self, samples, step_count):
        """(times, values) of the steps of a thing that moves in fewer than others."""
        stride = self._shutter.step_count // step_count
        steps = [step for step in samples if step % stride == 0]
        return [self._shutter.find_time(step) for step in steps], [samples[step] for step in steps]

    def _write(self):
        scene = self._exporter.scene
        for key, made in self._exporter.instances.items():
            if not self._steps[key]:
                continue
            if len(self._matrices[key]) <= self._shutter.step_count:
                self._report.add("object", key[0], COMES)
            self._write_objects(key, made.objects)
            self._write_lights(key, made.lights)
        self._write_materials()
        self._write_world(scene)
        self.cameras = {name: self._make_camera(name) for name in self._at_frame}
        self._folder = self._meshes.write()
        if self._folder is not None or has_keys([self.cameras, *(getattr(scene, section) for section in SECTIONS)]):
            half = self._shutter.length / 2
            for camera in self.cameras.values():
                camera["shutter"] = [-half, half]
            self.settings = {"frame": half}

    def _write_objects(self, key, entries):
        times, matrices = self._choose(self._matrices[key], self._steps[key])
        if not entries or all(np.array_equal(matrices[0], matrix) for matrix in matrices):
            return
        poses = motion_keys.find_poses(matrices)
        if poses is None:
            is_blurred = [self._meshes.bake(entry, self._matrices[key]) for entry in entries]
            self._report.add("object", key[0], STRAIGHT if all(is_blurred) else STILL)
            return
        for entry in entries:
            entry["transform"] = motion_keys.make_transform(times, poses)
            derived = self._exporter.materials.derived.get(entry.get("displacement"), ("", 1.0))
            is_scaled = any(not np.allclose(pose.scale, poses[0].scale, rtol=1e-4) for pose in poses)
            if is_scaled and derived[1] != 1:
                self._report.add("object", key[0], "motion blur: heights in world space keep their length of the frame")

    def _write_lights(self, key, lights):
        def tell(name):
            self._report.add("light", key[0], f"motion blur: its {name} stays as at the frame")
        times, matrices = self._choose(self._matrices[key], self._steps[key])
        _, samples = self._choose(self._lights[key], self._steps[key])
        if lights and None in samples:
            self._report.add("light", key[0], NOT_FINITE)
            return
        for light in lights if samples else []:
            moving = {"position", "direction", "up"}
            base = {name: value for name, value in light.items() if name in samples[0] and name not in moving}
            motion_keys.merge(base, times, [{n: v for n, v in s.items() if n not in moving} for s in samples], tell)
            light.update(base)
            if not all(np.array_equal(matrices[0], matrix) for matrix in matrices):
                motion_keys.add_directions(light, times, matrices)

    def _write_materials(self):
        scene = self._exporter.scene
        times = [self._shutter.find_time(step) for step in range(self._shutter.step_count + 1)]
        for name in self._sources:
            def tell(what, owner=name):
                self._report.add("material", owner, f"motion blur: {what} stays as at the frame")
            motion_keys.merge(scene.materials[name], times, list(self._materials[name].values()), tell)
            samples = list(self._displacements[name].values())
            if name in scene.displacements and all(sample is not None for sample in samples):
                motion_keys.merge(scene.displacements[name], times, samples, lambda what: tell(f"displacement {what}"))
            elif name in scene.displacements or any(sample is not None for sample in samples):
                tell("displacement")
            if name in self._exporter.materials.without_normals:
                self._exporter.materials.copy_without_normal_map(name)
        for name, (source, factor) in self._exporter.materials.derived.items():
            self._copy_keys(scene.displacements[source], scene.displacements[name], factor)

    @staticmethod
    def _copy_keys(source, derived, factor):
        for key, scale in (("scale", factor), ("midlevel", 1.0)):
            if isinstance(source.get(key), dict):
                derived[key] = {"keys": [[time, value * scale] for time, value in source[key]["keys"]]}

    def _write_world(self, scene):
        if not self._worlds:
            return

        def tell(what):
            self._report.add("world", "", f"motion blur: its {what} stays as at the frame")
        samples = list(self._worlds.values())
        if all("rotate_degrees" in sample for sample in samples):
            turns = motion_keys.unwrap_degrees([sample["rotate_degrees"] for sample in samples])
            for sample, turn in zip(samples, turns):
                sample["rotate_degrees"] = turn
        motion_keys.merge(scene.environment, [self._shutter.find_time(step) for step in self._worlds], samples, tell)

    def _make_camera(self, name):
        """The camera of a view, with keys; passes are made with that of the frame."""
        result = relief.Camera(self._at_frame[name].camera)
        if not self._camera_steps:
            return result

        def tell(what):
            self._report.add("camera", self._camera.name, f"motion blur: its {what} stays as at the frame")
        times, views = self._choose({step: views[name] for step, views in self._views.items()}, self._camera_steps)
        still = {"from", "to", "up"}
        motion_keys.merge(result, times, [{**v.camera, **{k: result[k] for k in still}} for v in views], tell)
        matrices = [view.matrix for view in views]
        offsets = [view.depth_offset for view in views]
        if any(not np.array_equal(matrices[0], m) or offsets[0] != o for m, o in zip(matrices, offsets)):
            motion_keys.add_view(result, times, motion_keys.find_poses(matrices), offsets)
        return result
