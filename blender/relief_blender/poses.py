"""Transforms in between: places, rotations and scales of matrices."""
from typing import NamedTuple

import numpy as np

SHEAR_TOLERANCE = 1e-4  # of the cosine between two axes
POLE = 1 - 1e-9         # sine of the middle angle above which x and z turn about one axis


class Pose(NamedTuple):
    """Matrix = translation, rotation, scale, from left to right."""
    place: np.ndarray
    rotation: np.ndarray  # 3x3
    scale: np.ndarray     # of the object's axes; the first is negative where it is mirrored


def find_pose(matrix):
    """The Pose of a 4x4 matrix, or None where it shears or leaves no volume."""
    linear = np.asarray(matrix, float)[:3, :3]
    scale = np.linalg.norm(linear, axis=0)
    if scale.min() <= 1e-12 * scale.max() or scale.max() == 0:
        return None
    rotation = linear / scale
    if np.abs(rotation.T @ rotation - np.eye(3)).max() > SHEAR_TOLERANCE:
        return None
    if np.linalg.det(rotation) < 0:
        scale, rotation = scale * [-1, 1, 1], rotation * [-1, 1, 1]
    u, _, v = np.linalg.svd(rotation)
    return Pose(np.asarray(matrix, float)[:3, 3], u @ v, scale)


def find_aim(matrix):
    """The Pose of what has a direction, -z, and an up, but no size: any matrix has one."""
    linear = np.asarray(matrix, float)[:3, :3]
    back = linear[:, 2] / max(np.linalg.norm(linear[:, 2]), 1e-30)
    up = linear[:, 1] - back * (linear[:, 1] @ back)
    if min(np.linalg.norm(back), np.linalg.norm(up)) < 1e-12:
        return Pose(np.asarray(matrix, float)[:3, 3], np.eye(3), np.ones(3))
    up /= np.linalg.norm(up)
    return Pose(np.asarray(matrix, float)[:3, 3], np.stack([np.cross(up, back), up, back], -1), np.ones(3))


def find_turn(first, second):
    """(axis, angle in radians, [0, pi]) of the shortest rotation that leads from one 3x3 matrix to another."""
    matrix = second @ first.T
    cross = np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])
    sine = np.linalg.norm(cross) / 2
    angle = float(np.arctan2(sine, (np.trace(matrix) - 1) / 2))
    if sine > 1e-9:
        return cross / (2 * sine), angle
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return vectors[:, np.argmax(values)], angle


def rotate(axis, angle):
    """3x3 matrix (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def blend_poses(first, second, weight):
    """Places and scales linearly, rotations at one speed on the shortest way."""
    axis, angle = find_turn(first.rotation, second.rotation)
    return Pose((1 - weight) * first.place + weight * second.place, rotate(axis, weight * angle) @ first.rotation,
                (1 - weight) * first.scale + weight * second.scale)


def refine(times, poses, most_degrees):
    """(times, poses) with others in between, so that none turns by more than `most_degrees` from the one before it."""
    all_times, all_poses = [times[0]], [poses[0]]
    for k in range(1, len(times)):
        _, angle = find_turn(poses[k - 1].rotation, poses[k].rotation)
        count = max(int(np.ceil(np.degrees(angle) / most_degrees - 1e-6)), 1)
        for part in range(1, count + 1):
            weight = part / count
            all_times.append(times[k - 1] + weight * (times[k] - times[k - 1]))
            all_poses.append(blend_poses(poses[k - 1], poses[k], weight))
    return all_times, all_poses


def find_angles(rotation, before=None):
    """Degrees about x, then y, then z, as `rotate_degrees`: of all that mean this rotation, the nearest to those `before`."""
    before = np.zeros(3) if before is None else np.asarray(before, float)
    sine = np.clip(-rotation[2, 0], -1, 1)
    if abs(sine) > POLE:
        x = np.radians(before[0])
        # At a pole the angles of x and z only count together.
        together = np.arctan2(np.copysign(1, sine) * rotation[0, 1], rotation[1, 1])
        z = np.copysign(1, sine) * (x - together)
        choices = [np.degrees([x, np.copysign(np.pi / 2, sine), z])]
    else:
        angles = np.degrees([np.arctan2(rotation[2, 1], rotation[2, 2]), np.arcsin(sine),
                             np.arctan2(rotation[1, 0], rotation[0, 0])])
        choices = [angles, angles * [1, -1, 1] + 180]
    choices = [angles + 360 * np.round((before - angles) / 360) for angles in choices]
    return min(choices, key=lambda angles: np.abs(angles - before).sum())
