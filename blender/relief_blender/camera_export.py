"""Blender's camera as Relief's, with the window of the picture that is rendered."""
import math
from collections import defaultdict
from typing import NamedTuple

import numpy as np
import relief

from . import axes

USUAL_CLIP_START = 0.1001  # about that of new cameras: what lies before it is not named, as much of a ground does
FAR = 1000  # how many times its height an orthographic view is looked at from


class View(NamedTuple):
    """A camera and the picture that `crop` is a window of: x0, y0, x1, y1 from the top left."""
    camera: object
    size: tuple
    crop: tuple
    forward: np.ndarray  # in Relief's axes
    right: np.ndarray
    up: np.ndarray
    tangent: float       # of half the vertical angle of the whole picture
    depth_offset: float  # by how much depths are too large

    @property
    def matrix(self):
        """4x4 of Relief's world from where Blender has the camera."""
        result = np.eye(4)
        result[:3, :3] = np.stack([self.right, self.up, -self.forward], -1)
        result[:3, 3] = np.array(self.camera["from"]) + self.depth_offset * self.forward
        return result


def find_basis(matrix_world):
    """(origin, right, up, forward) of a camera in Relief's axes; its scale does not count."""
    matrix = axes.convert_matrix(matrix_world)
    right, up, back = (matrix[:3, i] / np.linalg.norm(matrix[:3, i]) for i in range(3))
    return matrix[:3, 3], right, up, -back


def find_shift(projection, width, height):
    """The middle of the picture from the view axis, to the right and up, in heights of the picture."""
    is_orthographic = projection[3][3] == 1
    across, upwards = (-projection[i][3] if is_orthographic else projection[i][2] for i in range(2))
    return [across * width / (2 * height), upwards / 2]


def find_focus(camera, origin, forward):
    """Distance along the view axis."""
    target = camera.dof.focus_object
    if target is None:
        return camera.dof.focus_distance
    return float(np.dot(np.array(axes.convert_vector(target.matrix_world.translation)) - origin, forward))


def make_view(frame, projection, basis, report):
    """The View of a projection matrix.

    frame: (width, height, border), border None or x0, y0, x1, y1 in pixels from the top left.
    projection: 4x4 of OpenGL, as calc_matrix_camera gives it."""
    width, height, border = frame
    origin, right, up, forward = basis
    is_orthographic = projection[3][3] == 1
    if abs(projection[1][1] / projection[0][0] * height / width - 1) > 1e-3:
        report("pixels that are not square are taken for square ones")
    tangent, offset, target = 1 / projection[1][1], 0.0, origin + forward
    if is_orthographic:
        report(f"an orthographic view is a view from {FAR} times its height away")
        offset = FAR * 2 * tangent
        origin = origin - forward * offset
        tangent = tangent / offset
    camera = relief.Camera(from_=origin.tolist(), to=target.tolist(), up=up.tolist(),
                           fov_degrees=math.degrees(2 * math.atan(tangent)), focus_distance=1.0,
                           shift=find_shift(projection, width, height))
    crop = border or (0, 0, width, height)
    return View(camera, (width, height), crop, forward, right, up, tangent, offset)


def add_depth_of_field(view, camera, basis, report):
    """Lens and focus of a bpy.types.Camera."""
    if not camera.dof.use_dof:
        return
    if camera.type != "PERSP":
        report("depth of field of a view that is not a perspective is left out")
        return
    view.camera["aperture_radius"] = camera.lens * 1e-3 / (2 * camera.dof.aperture_fstop)
    view.camera["focus_distance"] = max(find_focus(camera, basis[0], basis[3]), 1e-4)
    if camera.dof.aperture_blades or camera.dof.aperture_ratio != 1:
        report("the aperture is round")


def report_clipping(scene, view, camera, report):
    """Names the ends of an evaluated camera's range that cut boxes around objects of the relief.Scene in Cycles."""
    places = defaultdict(list)
    for entry in scene.objects:
        places[entry["mesh"]].append(entry["transform"]["matrix"])
    nearest, farthest = np.inf, -np.inf
    for name, matrices in places.items():
        points = scene.meshes[name].positions
        ends = np.stack([points.min(0), points.max(0)])
        box = np.array([[x, y, z, 1] for x in ends[:, 0] for y in ends[:, 1] for z in ends[:, 2]], float)
        corners = box @ np.array(matrices).reshape(-1, 4, 4)[:, :3].transpose(0, 2, 1)
        depths = (corners - view.matrix[:3, 3]) @ view.forward
        ahead = depths[depths.max(-1) > 0]
        # An orthographic view sees what is behind the camera, too.
        nearest = min(nearest, ahead.min(initial=np.inf) if view.depth_offset == 0 else depths.max(-1).min())
        farthest = max(farthest, depths.max())
    least = USUAL_CLIP_START if view.depth_offset == 0 else 0.0
    if nearest < camera.data.clip_start and camera.data.clip_start > least:
        report.add("camera", camera.name, "its clip start is left out: what is nearer is seen")
    if farthest > camera.data.clip_end:
        report.add("camera", camera.name, "its clip end is left out: what is farther away is seen")


def find_border(render, width, height):
    """Pixels of the border from the top left, half open, or None; as Blender rounds them."""
    if not render.use_border:
        return None
    x0, x1 = int(render.border_min_x * width), int(render.border_max_x * width)
    y0, y1 = int(render.border_min_y * height), int(render.border_max_y * height)
    if x1 <= x0 or y1 <= y0:
        return None
    return x0, height - y1, x1, height - y0


def shift_projection(projection, camera, shift_x, aspect):
    """Moves the picture of a projection matrix from the camera's own shift to another. aspect: width over height."""
    fit = {"AUTO": max(aspect, 1.0), "HORIZONTAL": aspect, "VERTICAL": 1.0}[camera.sensor_fit]
    across = 2 * (shift_x - camera.shift_x) * fit / aspect
    if projection[3][3] == 1:
        projection[0][3] -= across
    else:
        projection[0][2] += across


def export_camera(depsgraph, report, original, find_eye=None):
    """The View of a final render. `report` is a Report; `original`: a camera or None. find_eye: gives the matrix and the
    horizontal shift of the evaluated camera, where it stands for one of several views."""
    scene, render = depsgraph.scene, depsgraph.scene.render
    factor = render.resolution_percentage / 100
    width, height = max(int(render.resolution_x * factor), 1), max(int(render.resolution_y * factor), 1)
    if original is None:
        raise relief.Error("the scene has no camera", hint="Add > Camera, then Scene Properties > Camera")
    if original.type != "CAMERA":
        raise relief.Error(f'object "{original.name_full}" is used as a camera but is none',
                           hint="choose a camera in Scene Properties > Camera")
    camera = original.evaluated_get(depsgraph)
    matrix, shift_x = find_eye(camera) if find_eye else (np.array(camera.matrix_world), camera.data.shift_x)
    if not np.all(np.isfinite(matrix)) or np.min(axes.find_axis_scale(matrix)) == 0:
        raise relief.Error(f'camera "{camera.name}" has no direction by its scale, or its transform is not finite')

    def tell(text):
        report.add("camera", camera.name, text)
    if camera.data.type == "PANO":
        tell("a panoramic view is the perspective of its lens")
    projection = np.array(camera.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x,
                                                    scale_y=render.pixel_aspect_y))
    aspect = width * render.pixel_aspect_x / (height * render.pixel_aspect_y)
    shift_projection(projection, camera.data, shift_x, aspect)
    basis = find_basis(matrix)
    view = make_view((width, height, find_border(render, width, height)), projection, basis, tell)
    add_depth_of_field(view, camera.data, basis, tell)
    return view
