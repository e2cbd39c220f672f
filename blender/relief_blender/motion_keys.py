"""Values of one thing at several times as one value with keys."""
import numpy as np

from .poses import find_aim, find_angles, find_pose, refine

NOISE = 1e-6      # of sizes and strengths, which Blender finds from matrices of 32 bits
MOST_DEGREES = 5  # that a direction turns between two keys


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_numbers(value):
    return is_number(value) or isinstance(value, list) and len(value) > 0 and all(is_number(v) for v in value)


def is_same(a, b):
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return a is b or isinstance(a, np.ndarray) and isinstance(b, np.ndarray) and np.array_equal(a, b)
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(is_same(value, b[key]) for key, value in a.items())
    return a == b


def make_keys(times, values, noise=0.0):
    """A value of a scene; as it is where all are one, but for a share of `noise`. `values`: numbers or lists of numbers."""
    values = [v.tolist() if isinstance(v, np.ndarray) else v for v in values]
    if np.allclose(values, [values[0]] * len(values), rtol=noise, atol=0):
        return values[0]
    return {"keys": [[float(t), v] for t, v in zip(times, values)]}


def merge(base, times, samples, tell):
    """Gives numbers of the dict `base` keys where the dicts `samples` differ at `times`; what cannot be between two values
    stays, and tell(key) is called."""
    for key in sorted({name for values in (base, *samples) for name in values}):
        values = [sample.get(key) for sample in samples]
        if all(is_same(base.get(key), value) for value in values):
            continue
        if isinstance(base.get(key), dict) and all(isinstance(v, dict) for v in values):
            merge(base[key], times, values, lambda inner, outer=key: tell(f"{outer} {inner}"))
        elif is_numbers(base.get(key)) and all(is_numbers(v) and np.shape(v) == np.shape(base[key]) for v in values):
            base[key] = make_keys(times, values, NOISE)
        else:
            tell(key.replace("_", " "))


def unwrap_degrees(values):
    """Angles of which none is more than half a turn from the one before."""
    result = [values[0]]
    for value in values[1:]:
        result.append(value + 360 * round((result[-1] - value) / 360))
    return result


def find_poses(matrices):
    """Poses of 4x4 matrices, or None where one has none or turns inside out."""
    poses = [find_pose(matrix) for matrix in matrices]
    if any(pose is None for pose in poses) or len({pose.scale[0] > 0 for pose in poses}) > 1:
        return None
    return poses


def make_transform(times, poses):
    """Keys of an object's transform; renderers turn between two as blend_poses() does."""
    angles, before = [], None
    for pose in poses:
        before = find_angles(pose.rotation, before)
        angles.append(before)
    return {"translate": make_keys(times, [pose.place for pose in poses]), "rotate_degrees": make_keys(times, angles),
            "scale": make_keys(times, [pose.scale for pose in poses], NOISE)}


def add_directions(thing, times, matrices):
    """Keys of the place and the directions of a light, as arcs."""
    poses = [find_aim(matrix) for matrix in matrices]
    fine_times, fine = refine(times, poses, MOST_DEGREES)
    if "position" in thing:
        thing["position"] = make_keys(times, [pose.place for pose in poses])
    for key, axis, sign in (("direction", 2, -1), ("up", 1, 1)):
        if key in thing:
            thing[key] = make_keys(fine_times, [sign * pose.rotation[:, axis] for pose in fine])


def add_view(camera, times, poses, offsets):
    """Keys of a camera's place, aim and up, as arcs. `offsets`: how far behind its pose each is."""
    fine_times, fine = refine(times, poses, MOST_DEGREES)
    behind = np.interp(fine_times, times, offsets)
    ways = [-pose.rotation[:, 2] for pose in fine]
    camera["from"] = make_keys(fine_times, [pose.place - back * way for pose, back, way in zip(fine, behind, ways)])
    camera["to"] = make_keys(fine_times, [pose.place + way for pose, way in zip(fine, ways)])
    camera["up"] = make_keys(fine_times, [pose.rotation[:, 1] for pose in fine])
