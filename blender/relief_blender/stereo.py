"""The views of a final render: one, or those of Blender's stereoscopy."""
import numpy as np

from .camera_export import export_camera

ONE = [""]  # names of views without stereoscopy
EYES = {"left", "right"}


def find_names(scene):
    """Names of the views that Blender has results for."""
    render = scene.render
    if not render.use_multiview:
        return ONE
    return [view.name for view in render.views
            if view.use and (render.views_format == "MULTIVIEW" or view.name in EYES)] or ONE


def find_cameras(engine, scene):
    """{name of a view: its original camera or None}. `engine`: the bpy.types.RenderEngine."""
    result = {}
    for name in find_names(scene):
        engine.active_view_set(name)
        camera = engine.camera_override if name else scene.camera  # that of the view, by the suffix of its name
        result[name] = camera.original if camera else None
    return result


def find_views(engine, depsgraph, report, cameras):
    """{name: View}. cameras: see find_cameras(), which may be those of another frame."""
    result = {}
    for name, camera in cameras.items():
        def find_eye(evaluated, view=name):
            engine.active_view_set(view)
            return np.array(engine.camera_model_matrix(evaluated)), engine.camera_shift_x(evaluated)
        result[name] = export_camera(depsgraph, report, camera, find_eye if name else None)
    return result
