"""What all readers of a stage share: options, the time, the report, and errors."""
from __future__ import annotations

import contextlib
import dataclasses
import math
import os
import shutil
import tempfile
import weakref

import numpy as np
from pxr import Gf, Usd, UsdGeom

import relief


@dataclasses.dataclass
class Options:
    """As the keywords of relief.usd.load."""
    time: float | None = None
    camera: str | None = None
    purposes: tuple = ("default", "render")
    meters: bool = False
    subdivision_level: int | None = None
    vector_space: str = "tangent"
    folder: str | os.PathLike | None = None
    frames: str | None = None


NOTE = "note: "  # starts lines of a report about what is taken over


class Report:
    """What is not taken over, and what is taken over in another form: each thing once, all of a prim in one line of each."""

    def __init__(self) -> None:
        self.texts: dict = {}
        self.notes: dict = {}

    def add(self, prim, text: str) -> None:
        """Of what is left out or changed in its look."""
        self.texts.setdefault(get_path(prim), {})[text] = None

    def note(self, prim, text: str) -> None:
        """Of what is all there in another form."""
        self.notes.setdefault(get_path(prim), {})[text] = None

    def lines(self) -> list:
        return [f"{start}{path}: {'; '.join(texts)}" for start, lines in (("", self.texts), (NOTE, self.notes))
                for path, texts in lines.items()]


def get_path(prim) -> str:
    return prim if isinstance(prim, str) else str(prim.GetPath())


class Context:
    """A stage at one time, on the way to a relief.Scene."""

    def __init__(self, stage: Usd.Stage, path: str, options: Options) -> None:
        self.stage, self.path, self.options = stage, path, options
        self.report = Report()
        self.scene = relief.Scene()
        self.range = None  # a TimeRange, where frames are asked for
        self.taken: set = set()  # paths of attributes that keys have been made of
        self.sequences: set = set()  # names of numbered files
        self.time = find_time(stage, options.time)
        self.unit = UsdGeom.GetStageMetersPerUnit(stage) if options.meters else 1.0
        if not 0 < self.unit < math.inf:
            raise make_error(f"metersPerUnit is {self.unit:g}", path, "it has to be more than 0, or leave meters out")
        self.is_z_up = UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z
        self.upright = np.eye(4)
        if self.is_z_up:
            self.upright[1:3, 1:3] = [[0, 1], [-1, 0]]
        self.root = np.diag([self.unit, self.unit, self.unit, 1]) @ self.upright
        self.temporary: str | None = None  # a folder that lasts as long as the scene
        self.documents: list = []  # layers of MaterialX files
        self.baked: set = set()  # paths of the roots of skinned meshes that are posed

    @contextlib.contextmanager
    def at(self, time: float):
        """Reads at another time for a while."""
        before, self.time = self.time, Usd.TimeCode(time)
        try:
            yield
        finally:
            self.time = before

    def get_folder(self) -> str:
        """Where files are written that Relief has to read."""
        if self.options.folder is not None:
            os.makedirs(self.options.folder, exist_ok=True)
            return os.fspath(self.options.folder)
        if self.temporary is None:
            self.temporary = tempfile.mkdtemp(prefix="relief-usd-")
            weakref.finalize(self.scene, shutil.rmtree, self.temporary, ignore_errors=True)
        return self.temporary

    def fail(self, prim, message: str, hint: str = ""):
        raise make_error(message, f"{self.path}: {prim.GetPath()}", hint)

    @contextlib.contextmanager
    def reading(self, prim):
        """Whatever goes wrong with a prim is an error with its path."""
        try:
            yield
        except MemoryError:
            raise
        except Exception as error:
            if isinstance(error, relief.Error) and self.path in error.where:
                raise
            text = " ".join(str(error).split()) or type(error).__name__
            raise make_error(f"cannot be read: {text}", f"{self.path}: {prim.GetPath()}", "mend it, or deactivate the prim") from error

    def get(self, attribute, fallback=None, low: float = -math.inf, high: float = math.inf):
        """The value of an attribute at the time; `fallback` where there is none. Numbers outside of [low, high], and numbers,
        vectors and matrices that are not finite, are errors; arrays are checked by who reads them."""
        value = attribute.Get(self.time) if attribute else None
        if value is None:
            return fallback
        if not is_finite(value):
            self.fail(attribute.GetPrim(), f"{attribute.GetName()} is {value}{self.describe_time()}", "it has to be finite")
        if is_number(value) and not low <= value <= high:
            wanted = f"from {low:g} to {high:g}" if math.isfinite(high) else f"{low:g} or more"
            self.fail(attribute.GetPrim(), f"{attribute.GetName()} is {value:g}{self.describe_time()}", f"it has to be {wanted}")
        return value

    def get_whole(self, prim, name: str, low: int, high: int) -> int | None:
        """Of an attribute that save() or a user has noted; None where there is none."""
        attribute = prim.GetAttribute(name)
        value = attribute.Get() if attribute else None
        if value is None:
            return None
        if not (is_number(value) and low <= value <= high and value == int(value)):
            self.fail(prim, f"{name} is {value!r}", f"it has to be a whole number from {low} to {high}")
        return int(value)

    def describe_time(self) -> str:
        return "" if self.range is None else f" at frame {self.time.GetValue():g}"


def is_number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_finite(value) -> bool:
    """Of numbers, vectors and matrices; all else is."""
    has_numbers = is_number(value) or hasattr(type(value), "dimension")
    return not has_numbers or bool(np.isfinite(np.array(value, np.float64)).all())


def make_error(message: str, where: str, hint: str = "") -> relief.Error:
    return relief.Error(message, kind="bad_input", where=where, hint=hint)


def find_time(stage: Usd.Stage, time: float | None) -> Usd.TimeCode:
    if time is not None:
        return Usd.TimeCode(time)
    if stage.HasAuthoredTimeCodeRange():
        return Usd.TimeCode(stage.GetStartTimeCode())
    return Usd.TimeCode.EarliestTime()


def to_matrix(matrix: Gf.Matrix4d) -> np.ndarray:
    """For points as columns; those of USD are rows."""
    return np.array(matrix, np.float64).T


def to_array(values, width: int = 0, dtype=np.float64) -> np.ndarray:
    """A VtArray as an array of rows of `width`; 0: of numbers."""
    array = np.array(values if values is not None else [], dtype)
    return array.reshape(-1, width) if width else array.reshape(-1)


def read_hint(prim, name: str, derived: float, tolerance: float = 1e-5) -> float:
    """The number that save() has noted down exactly, as long as it still agrees with what the prim says."""
    attribute = prim.GetAttribute(name)
    noted = attribute.Get() if attribute else None
    if noted is None or not abs(noted - derived) <= tolerance * max(abs(derived), 1e-30):
        return derived
    return float(noted)
