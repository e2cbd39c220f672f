"""Transforms that change with time, as keys of translate, rotate_degrees and scale."""
from __future__ import annotations

import numpy as np
from pxr import Usd

from .context import Context
from .instances import to_quaternions
from .keys import NOISE, QUATERNION, Rules, Track
from .time_range import compute_world, list_times, list_transform_attributes, take
from .walk import Item

SMALLEST_SCALE = 1e-6  # of the largest: 0 would leave nothing, which a scene refuses
MAX_SHEAR = 1e-4       # of the scale; below it is taken as noise


class Carrier:
    """What moves an item: the prim itself, or the instancer that it stands in."""

    def __init__(self, context: Context, prim: Usd.Prim, times: list) -> None:
        self.context, self.prim, self.times = context, prim, times

    def compute_matrix(self, time: float) -> np.ndarray:
        return compute_world(self.context, self.prim, time)

    def compute_rest(self, matrices: np.ndarray) -> np.ndarray | None:
        """Places relative to the carrier, of those at the frame; None where it has no extent then."""
        world = self.compute_matrix(self.context.time.GetValue())
        if not abs(np.linalg.det(world)) > 0:
            return None
        return np.linalg.inv(world) @ matrices

    def make_transform(self, rest: np.ndarray) -> dict | None:
        """Keys of what stands at `rest` in the carrier; None where it has no extent at all."""
        return make_transform(self.context, self.prim, lambda time: self.compute_matrix(time) @ rest, self.times)


def find_carrier(context: Context, item: Item) -> Carrier | None:
    """None where nothing moves, or no frames are asked for."""
    if context.range is None:
        return None
    prim = item.instancer or item.prim
    attributes = list_transform_attributes(prim)
    times = list_times(context, attributes)
    if not times:
        return None
    take(context, attributes)
    return Carrier(context, prim, times)


def split_matrix(matrix: np.ndarray, hint: np.ndarray) -> tuple:
    """(rotation, scale): the nearest rotation and factors along its axes; mirrored things have a negative x."""
    linear = matrix[:3, :3]
    left, factors, right = np.linalg.svd(linear)
    if factors[1] <= 1e-9 * max(factors[0], 1e-300) or factors[0] == 0:
        turn = hint
    else:
        turn = left @ right
        is_flat = factors[2] <= 1e-9 * factors[0]
        if np.linalg.det(turn) < 0:
            # What is flat has no side: it is not mirrored, but the last axis is turned round.
            turn = left @ np.diag([1, 1, -1]) @ right if is_flat else turn @ np.diag([-1, 1, 1])
    return turn, np.einsum("ij,ij->j", turn, linear)


def find_angles(turn: np.ndarray, before: np.ndarray) -> np.ndarray:
    """Degrees about x, then y, then z, of the ways to say it the one nearest to that of the key before: where only one angle
    changes a scene goes from number to number."""
    across = np.hypot(turn[0, 0], turn[1, 0])
    y = np.arctan2(-turn[2, 0], across)
    if across < 1e-9:  # x and z turn about one axis
        x = np.radians(before[0])
        z = np.arctan2(-turn[0, 1], turn[1, 1]) + np.sign(y) * x
    else:
        x, z = np.arctan2(turn[2, 1], turn[2, 2]), np.arctan2(turn[1, 0], turn[0, 0])
    first = np.degrees([x, y, z])
    ways = [first, first * [1, -1, 1] + 180]
    nearest = [way + 360 * np.round((before - way) / 360) for way in ways]
    return np.round(min(nearest, key=lambda way: np.abs(way - before).sum()), 9)


def make_transform(context: Context, prim: Usd.Prim, compute, times: list) -> dict | None:
    shears, hint = [0.0], [np.eye(3)]
    for time in times:  # what has no extent at first is turned as later
        matrix = compute(time)
        if abs(np.linalg.det(matrix[:3, :3])) > 0:
            hint[0] = split_matrix(matrix, np.eye(3))[0]
            break

    def evaluate(time: float) -> dict:
        matrix = compute(time)
        turn, scale = split_matrix(matrix, hint[0])
        hint[0] = turn
        rest = np.abs(matrix[:3, :3] - turn * scale).max() / max(np.abs(scale).max(), 1e-300)
        shears.append(float(rest))
        return {"translate": matrix[:3, 3], "turn": to_quaternions(turn[None])[0], "scale": scale}

    track = Track(evaluate, times, Rules({"turn": QUATERNION}))
    if not track.is_exact:
        context.report.add(prim, "moves faster than its keys can follow")
    if max(shears) > MAX_SHEAR:
        context.report.add(prim, f"is sheared on its way, by {max(shears):.2g} of its size: keys hold its turn and scale alone")
    return write_transform(track)


def write_transform(track: Track) -> dict | None:
    scales = np.array([track.value(t)["scale"] for t in track.times])
    largest = np.abs(scales).max()
    if not largest > 0:
        return None
    floor = SMALLEST_SCALE * largest
    scales = np.where(np.abs(scales) < floor, np.where(scales < 0, -floor, floor), scales)
    if np.abs(scales - scales[0]).max() <= NOISE * largest:
        scales[:] = scales[0]
    angles, before = [], np.zeros(3)
    for time in track.times:
        before = find_angles(to_matrix(track.value(time)["turn"]), before)
        angles.append(before)
    found = {"translate": track.make_value("translate"), "rotate_degrees": track.make_value("turn_degrees", angles),
             "scale": track.make_value("scale", list(scales))}
    neutral = {"translate": [0, 0, 0], "rotate_degrees": [0, 0, 0], "scale": [1, 1, 1]}
    return {name: value for name, value in found.items() if value != neutral[name]}


def to_matrix(q: np.ndarray) -> np.ndarray:
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def key_part(context: Context, prim: Usd.Prim, names: list, read, rules: Rules | None = None) -> dict:
    """The numbers of a light, a camera or an environment that change, as keys. `names`: attributes that they come from;
    `read(matrix)`: the part at the time of the context, None where there is none."""
    if context.range is None:
        return {}
    attributes = [prim.GetAttribute(name) for name in names if prim.HasAttribute(name)] + list_transform_attributes(prim)
    times = list_times(context, attributes)
    if not times:
        return {}

    def evaluate(time: float):
        with context.at(time):
            return read(compute_world(context, prim, time))

    track = Track(evaluate, times, rules or Rules())
    if not track.is_whole:
        return {}
    if not track.is_exact:
        context.report.add(prim, "changes faster than its keys can follow")
    take(context, attributes)
    return {name: track.make_value(name) for name in track.value(times[0])}
