"""Values as keys, with as many of them as it takes for what lies between two to agree with the stage.

A scene interpolates numbers linearly and rotations the shortest way at one speed (Shoemake 1985), a stage its own operations:
intervals are halved until both agree."""
from __future__ import annotations

import dataclasses
import math
import typing

import numpy as np

FRACTIONS = (0.137, 0.382, 0.5, 0.771)  # of an interval, where both are compared; not alike, as full turns would hide
SHORTEST = 1 / 64    # interval, frames
TOLERANCE = 1e-4     # of what a value changes by, and of quaternions
NOISE = 1e-6         # of the largest value: USD has single precision
QUATERNION, ANGLE = "quaternion", "angle"  # kinds of values; an angle in degrees goes the shorter way


def blend(kind: str | None, a: np.ndarray, b: np.ndarray, w: float) -> np.ndarray:
    if kind == ANGLE:
        return a + w * measure(kind, b, a)
    if kind != QUATERNION:
        return a + w * (b - a)
    b = -b if np.dot(a, b) < 0 else b
    angle = math.acos(min(float(np.dot(a, b)), 1.0))
    if angle < 1e-6:
        return (1 - w) * a + w * b
    return (math.sin((1 - w) * angle) * a + math.sin(w * angle) * b) / math.sin(angle)


def measure(kind: str | None, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a - b."""
    if kind == ANGLE:
        return (a - b + 180) % 360 - 180
    return a + b if kind == QUATERNION and np.dot(a, b) < 0 else a - b


@dataclasses.dataclass
class Rules:
    """Of values by their names, where they are not numbers in a line: QUATERNION or ANGLE; the largest error that is allowed."""
    kinds: dict = dataclasses.field(default_factory=dict)
    limits: dict = dataclasses.field(default_factory=dict)


class Track:
    """Values by their names at times; `evaluate` gives those of a time as a dict of arrays, or None where there is none."""

    def __init__(self, evaluate: typing.Callable, times: list, rules: Rules) -> None:
        self.evaluate, self.kinds, self.limits = evaluate, rules.kinds, rules.limits
        self.cache: dict = {}
        self.times = list(times)
        self.is_exact = True
        probes = [self.value(t) for t in times] + [self.value(t) for a, b in zip(times, times[1:]) for t in list_probes(a, b)]
        self.is_whole = all(probe is not None for probe in probes)
        if self.is_whole:
            self.tolerances = {name: self.find_tolerance(name, probes) for name in probes[0]}
            self.refine()

    def value(self, time: float):
        if time not in self.cache:
            found = self.evaluate(time)
            self.cache[time] = None if found is None else {name: np.array(v, np.float64).reshape(-1) for name, v in found.items()}
        return self.cache[time]

    def find_tolerance(self, name: str, probes: list) -> float:
        if name in self.kinds:
            return TOLERANCE if self.kinds[name] == QUATERNION else 100 * TOLERANCE
        values = np.array([probe[name] for probe in probes])
        largest = float(np.abs(values).max())
        wanted = min(TOLERANCE * float(np.ptp(values, axis=0).max()), self.limits.get(name, math.inf))
        return max(wanted, NOISE * largest, 1e-12)

    def agrees(self, a: float, b: float) -> bool:
        first, last = self.value(a), self.value(b)
        for part, time in zip(FRACTIONS, list_probes(a, b)):
            found = self.value(time)
            if found is None:
                self.is_whole = False
                return True
            for name, value in found.items():
                kind = self.kinds.get(name)
                if np.abs(measure(kind, value, blend(kind, first[name], last[name], part))).max() > self.tolerances[name]:
                    return False
        return True

    def refine(self) -> None:
        done, left = [self.times[0]], self.times[:0:-1]
        while left:
            a, b = done[-1], left[-1]
            if self.agrees(a, b):
                done.append(left.pop())
            elif b - a <= SHORTEST:
                self.is_exact = False
                done.append(left.pop())
            else:
                left.append(find_middle(a, b))
            if self.value(left[-1] if left else done[-1]) is None:
                self.is_whole = False
                return
        self.times = done

    def make_value(self, name: str, values: list | None = None):
        """A value of a scene file: keys, or one where it never changes. `values`: those of the times in place of the track's."""
        rows = np.array([self.value(t)[name] for t in self.times] if values is None else values)
        if self.kinds.get(name) == ANGLE:
            rows = np.degrees(np.unwrap(np.radians(rows), axis=0))
        plain = [[float(x) + 0.0 for x in row] for row in rows]
        plain = [row[0] if len(row) == 1 else row for row in plain]
        if np.abs(rows - rows[0]).max() <= 1e-9 * max(np.abs(rows).max(), 1e-3):
            return plain[0]
        return {"keys": [[int(t) if t == int(t) else t, value] for t, value in zip(self.times, plain)]}


def list_probes(a: float, b: float) -> list:
    return [a + (b - a) * part for part in FRACTIONS]


def find_middle(a: float, b: float) -> float:
    """A whole frame, where one lies between."""
    whole = round((a + b) / 2)
    return float(whole) if a < whole < b else (a + b) / 2


def read_numbers(keys: dict) -> dict:
    """Those of a part that may have keys."""
    def is_number(value) -> bool:
        return isinstance(value, (int, float)) and not isinstance(value, bool)

    return {name: value for name, value in keys.items()
            if is_number(value) or (isinstance(value, list) and value and all(map(is_number, value)))}
