"""From a stage to a scene: opens it, walks over its prims, and hands each to its reader."""
from __future__ import annotations

import math
import os
import re

import numpy as np
from pxr import Gf, Tf, Usd, UsdGeom, UsdRender, UsdSkel, UsdUtils

import relief

from .cameras import choose_camera
from .context import Context, Options, make_error
from .lights import add_lights
from .mtlx_files import add_files
from .objects import ObjectReader
from .pictures import check_pictures
from .time_range import read_range, report_other_motion
from .walk import walk

KINDS = {"time": ((int, float, np.integer, np.floating), "a time code, a number"), "frames": (str, '"1-24", "1-100x2,150" or "all"'),
         "camera": (str, "the path of a camera"), "subdivision_level": ((int, np.integer), "0 to 8")}
PURPOSES = ("default", "render", "proxy", "guide")
MAX_SIZE = 65536  # pixels of a side
RENDER_KEYS = {"spp": (1, 2**20), "bounces": (0, 1000), "seed": (0, 2**32 - 1)}

__all__ = ["Options", "load_scene"]

NOT_SHAPES = ("Xform", "Scope", "Material", "Shader", "NodeGraph", "GeomSubset", "RenderSettings", "RenderProduct",
              "RenderVar", "RenderPass", "SkelRoot", "Skeleton", "SkelAnimation", "BlendShape", "", "Backdrop",
              "PhysicsScene", "LightFilter")


def explain(error: Tf.ErrorException, path: str) -> str:
    """The first of the errors, with its line of the file."""
    found = re.search(r" in file \S+ : '(.*?)\s*'(?=\n|$)", str(error), re.S)
    text = " ".join(found.group(1).split()) if found else str(error).strip().splitlines()[-1]
    place = re.match(re.escape(path) + r":(\d+):(\d+): *(.*)", text)
    return f"line {place.group(1)}, column {place.group(2)}: {place.group(3)}" if place else text


def open_stage(path: str) -> Usd.Stage:
    if not os.path.exists(path):
        raise make_error("no such file", path, "is the path relative to another folder?")
    warnings = UsdUtils.CoalescingDiagnosticDelegate()  # kept back: what is missing is in the report
    try:
        stage = Usd.Stage.Open(path, Usd.Stage.LoadAll)
    except Tf.ErrorException as error:
        raise make_error(f"is not a USD file: {explain(error, path)}", path, "usd, usda, usdc and usdz are read") from None
    finally:
        warnings.TakeUncoalescedDiagnostics()
    if stage is None:
        raise make_error("is not a USD file", path, "usd, usda, usdc and usdz are read")
    return stage


def describe(error) -> str:
    """What could not be opened or found, in one line."""
    text = str(error).strip().splitlines()[0]
    found = re.search(r"Could not open asset @(?:[^@]*/)?([^@]+)@", text)
    return f"{found.group(1)} cannot be opened" if found else text


def complete(context: Context) -> None:
    """MaterialX files are read here; what else is missing goes into the report."""
    errors = [(error.rootSite.path, describe(error)) for error in context.stage.GetCompositionErrors()]
    warnings = UsdUtils.CoalescingDiagnosticDelegate()  # of composing anew what is missing still
    read = add_files(context, [path for path, text in errors if ".mtlx cannot" in text])
    warnings.TakeUncoalescedDiagnostics()
    for path, text in errors:
        if text.removesuffix(" cannot be opened") not in read:
            context.report.add(str(path), text)


def bake_skinning(context: Context) -> None:
    """Skinned points at the time, into the session layer; those of instances stay in their rest pose."""
    roots = [prim for prim in context.stage.Traverse() if prim.IsA(UsdSkel.Root)]
    if not roots:
        return
    context.stage.SetEditTarget(context.stage.GetSessionLayer())
    first = last = context.time.GetValue()
    if context.range is not None:
        frames = context.range.list_frames()
        first, last = frames[0], frames[-1]
    interval = Gf.Interval(first, last)
    for root in roots:
        if UsdSkel.BakeSkinning(UsdSkel.Root(root), interval):
            context.baked.add(root.GetPath())


def check_options(options: Options, path: str) -> None:
    for name in ("time", "frames", "camera", "subdivision_level"):
        value, (kinds, wanted) = getattr(options, name), KINDS[name]
        if value is not None and (isinstance(value, bool) or not isinstance(value, kinds)):
            raise make_error(f"{name} is {value!r}", path, f"it has to be {wanted}")
    if options.time is not None and not math.isfinite(options.time):
        raise make_error(f"time is {options.time}", path, "it has to be a time code")
    unknown = [name for name in options.purposes if name not in PURPOSES]
    if unknown:
        raise make_error(f"purposes has {unknown[0]!r}", path, f"they are a list of {', '.join(PURPOSES)}")
    if options.vector_space not in ("tangent", "object"):
        raise make_error(f"vector_space is {options.vector_space!r}", path, 'it is "tangent" or "object"')
    level = options.subdivision_level
    if level is not None and not 0 <= level <= 8:
        raise make_error(f"subdivision_level is {level}", path, "it is 0 to 8")


def set_size(context: Context, settings, camera) -> None:
    """The size of the picture: that of the render settings, else of the aspect of the camera."""
    resolution = context.get(settings.GetResolutionAttr()) if settings else None
    if resolution:
        if not all(1 <= side <= MAX_SIZE for side in resolution):
            context.fail(settings.GetPrim(), f"resolution is {resolution}", f"both sides have to be 1 to {MAX_SIZE} pixels")
        context.scene.render.update(width=int(resolution[0]), height=int(resolution[1]))
    elif camera is not None:
        across = context.get(camera.GetHorizontalApertureAttr(), 0)
        high = context.get(camera.GetVerticalApertureAttr(), 0)
        if across > 0 and high > 0:
            context.scene.render.update(width=1280, height=min(max(1, round(1280 * high / across)), MAX_SIZE))


def find_settings(stage: Usd.Stage):
    settings = UsdRender.Settings.GetStageRenderSettings(stage)
    if settings:
        return settings
    every = (prim for prim in stage.Traverse() if prim.IsA(UsdRender.Settings))
    found = next(every, None)
    return UsdRender.Settings(found) if found else None


def read_render_keys(context: Context, settings) -> None:
    for key, limits in RENDER_KEYS.items() if settings else ():
        value = context.get_whole(settings.GetPrim(), f"relief:{key}", *limits)
        if value is not None:
            context.scene.render[key] = value


def read_stage(context: Context) -> None:
    complete(context)
    bake_skinning(context)
    objects = ObjectReader(context)
    cameras, lights, others = [], [], []
    for item in walk(context, context.stage.GetPseudoRoot(), context.root):
        prim = item.prim
        if prim.IsA(UsdGeom.Camera):
            cameras.append(item)
            continue
        others.append(item)
        if item.is_light():
            lights.append(item)
        elif objects.can_read(prim):
            with context.reading(prim):
                objects.add(item)
        elif prim.GetTypeName() not in NOT_SHAPES:
            context.report.add(prim, f"{prim.GetTypeName()} is not taken over")
        if item.is_light() and objects.can_read(prim):
            context.report.add(prim, "the light of a mesh is not taken over")
    camera = finish(context, objects, cameras, lights)
    if context.range is not None:
        chosen = [item for item in cameras if camera is not None and item.prim == camera.GetPrim()]
        report_other_motion(context, others + chosen)


def load_scene(path: str, options: Options, report: list | None) -> relief.Scene:
    stage = open_stage(path)
    check_options(options, path)
    context = Context(stage, path, options)
    context.range = read_range(stage, options, path)
    if context.range is not None and options.time is None:
        context.time = Usd.TimeCode(context.range.first)
    try:
        with context.reading(stage.GetPseudoRoot()):
            read_stage(context)
    finally:  # it may say why nothing is left
        if report is not None:
            report += context.report.lines()
    return context.scene


def scale_lengths(context: Context) -> None:
    """Those that no transform of an object scales."""
    for material in context.scene.materials.values():
        if "transmission_depth" in material:
            material["transmission_depth"] *= context.unit
    for displacement in context.scene.displacements.values():
        if displacement.get("space") == "world" and context.unit != 1:
            displacement["scale"] = (np.array(displacement.get("scale", 1.0)) * context.unit).tolist()


def frame_all(scene: relief.Scene) -> dict:
    """A camera that shows everything; without the pictures of the scene, which need not be read for it."""
    bare = relief.Scene()
    bare.meshes = scene.meshes
    bare.render = {key: value for key, value in scene.render.items() if key == "frames"}
    bare.objects = [{key: value for key, value in entry.items() if key in ("mesh", "transform", "instances")}
                    for entry in scene.objects]
    bare.aim(frame_all=True, size=(scene.render.get("width", 1280), scene.render.get("height", 720)))
    return bare.camera


def finish(context: Context, objects: ObjectReader, cameras: list, lights: list):
    """Returns the camera that is taken, or None."""
    scene = context.scene
    if context.range is not None:
        scene.render.update(frames=context.range.text, fps=float(context.stage.GetTimeCodesPerSecond()))
    if not scene.objects:
        raise make_error("has no mesh that can be seen", context.path,
                         "purposes, visibility and the default prim decide what is seen; see the option purposes")
    settings = find_settings(context.stage)
    camera = choose_camera(context, settings, cameras)
    set_size(context, settings, camera)
    scale_lengths(context)
    read_render_keys(context, settings)
    add_lights(context, lights, objects.paths_of_names)
    if not scene.lights and scene.environment is None and not objects.emits():
        scene.environment = relief.Environment(color=[1, 1, 1], strength=1)
        context.report.note("/", "has no light: a white sky is used")
    if camera is None:
        context.report.note("/", "has no camera: one that shows everything is used")
        scene.camera = frame_all(scene)
    check_pictures(context)
    return camera
