"""When Blender's shutter is open, and at how many times the scene is looked at meanwhile."""
from typing import NamedTuple

MAX_LENGTH = 32  # frames that a shutter of Relief may be open for
CURVE_SAMPLES = 64
CURVE_TOLERANCE = 1e-3


class Shutter(NamedTuple):
    """Frames of Blender from `open` to `close`, in `step_count` equal steps, a power of two.

    The scene of Relief has a time of its own, in which steps are whole frames as far as the shutter may be open: numbered
    meshes stand at whole frames."""
    open: float
    close: float
    step_count: int

    @property
    def length(self):
        """Frames of Relief."""
        return min(self.step_count, MAX_LENGTH)

    @property
    def stride(self):
        """Steps between two numbered meshes."""
        return self.step_count // self.length

    def find_frame(self, step):
        """Of Blender."""
        return self.open + (self.close - self.open) * step / self.step_count

    def find_time(self, step):
        """Frames of Relief."""
        return step * self.length / self.step_count


def find_steps(*objects):
    """Steps in which an object moves, as in Cycles: 2, 4, ... 128; 0: it stays still. `objects`: original ones, the object
    and whatever makes instances of it."""
    settings = [getattr(ob, "cycles", None) for ob in objects]
    if not all(getattr(own, "use_motion_blur", True) for own in settings):
        return 0
    return 2 ** max(max(getattr(own, "motion_steps", 1), 1) for own in settings)


def can_deform(ob):
    """Whether the object's settings let its mesh move."""
    return getattr(getattr(ob, "cycles", None), "use_deform_motion", True)


def find_times(scene):
    """(open, close) of a bpy.types.Scene at its frame, or None where there is no motion blur."""
    render = scene.render
    if not render.use_motion_blur or render.motion_blur_shutter <= 0:
        return None
    position = getattr(render, "motion_blur_position", None) or scene.cycles.motion_blur_position
    share = {"START": 0.0, "CENTER": 0.5, "END": 1.0}[position]
    frame = scene.frame_current + scene.frame_subframe
    return frame - share * render.motion_blur_shutter, frame + (1 - share) * render.motion_blur_shutter


def is_flat(mapping):
    """Whether a shutter curve lets as much light in at all times."""
    mapping.update()
    curve = mapping.curves[0]
    values = [mapping.evaluate(curve, k / CURVE_SAMPLES) for k in range(CURVE_SAMPLES + 1)]
    return max(values) - min(values) <= CURVE_TOLERANCE * max(values)


def report_differences(scene, report):
    """What of the settings is taken otherwise."""
    if not is_flat(scene.render.motion_blur_shutter_curve):
        report.add("scene", "", "motion blur: the shutter curve is taken for flat")
    if getattr(getattr(scene, "cycles", None), "rolling_shutter_type", "NONE") != "NONE":
        report.add("scene", "", "motion blur: the rolling shutter opens for the whole picture at once")
