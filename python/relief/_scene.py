"""Scenes as objects: the keys of the scene file, with meshes and arrays where it names files."""
from __future__ import annotations

import json
import math
import os
import re
from typing import Any, Mapping, Optional, Union, cast

import numpy as np

from . import _relief
from ._arguments import as_number, as_integer, refuse
from ._arrays import Array, as_path, as_texels, is_array, to_numpy
from ._errors import Error
from ._mesh import Mesh
from ._parts import Camera, Displacement, Environment, Light, Material
from ._save import is_moving, names_file, put_motion

Path = Union[str, "os.PathLike[str]"]

SECTIONS = ("version", "render", "camera", "environment", "materials", "displacements", "meshes", "objects", "lights")
NAMED_SECTIONS = ("materials", "displacements", "meshes")
FRAMES = (-1e6, 1e6)
MAX_PICTURE_SIZE = 65536  # pixels of a side


class Collector:
    """Turns values into those of JSON, and keeps what they refer to by made-up names."""

    def __init__(self) -> None:
        self.meshes: dict[str, dict[str, Array]] = {}
        self.textures: dict[str, Any] = {}

    def make_name(self) -> str:
        return f"memory:{len(self.textures)}"

    def name_picture(self, value: Any, place: str) -> Optional[str]:
        """The name of an array or of tiles; None for anything else."""
        name = self.make_name()
        if isinstance(value, Mapping) and value and all(isinstance(key, (int, np.integer)) for key in value):
            for udim, tile in value.items():
                if not 1001 <= int(udim) <= 9999:
                    raise ValueError(f"{place}: tiles are numbered from 1001 to 9999, as UDIM does, not {udim}")
                self.textures[f"{name}.{int(udim)}"] = as_texels(tile, f"{place}, tile {udim}")
            return f"{name}.<UDIM>"
        if not is_array(value) or to_numpy(value, place).ndim < 2:
            return None
        self.textures[name] = as_texels(value, place)
        return name

    def convert(self, value: Any, place: str, key: str = "") -> Any:
        if key == "keys" and is_array(value):
            value = to_numpy(value, place).tolist()
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f"{place}: {value} is not finite")
        if isinstance(value, (str, bool, int, float)) or value is None:
            return value
        name = self.name_picture(value, place)
        if name is not None:
            return name if names_file(key) else {"file": name}
        if isinstance(value, Mapping):
            return {str(k): self.convert(v, f"{place}.{k}", str(k)) for k, v in value.items() if v is not None}
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        if isinstance(value, np.generic):
            return self.convert(value.item(), place)
        if is_array(value):
            return self.convert(to_numpy(value, place).tolist(), place)
        if isinstance(value, (list, tuple)):
            return [self.convert(entry, f"{place}[{k}]") for k, entry in enumerate(value)]
        raise TypeError(f"{place}: {type(value).__name__} is no value of a scene file")

    def convert_mesh(self, value: Any, name: str) -> Any:
        keys = dict(value) if isinstance(value, Mapping) else {"file": value}
        mesh = keys.get("file")
        if isinstance(mesh, Mesh):
            keys["file"] = f"memory:mesh {len(self.meshes)}"
            try:
                self.meshes[keys["file"]] = mesh._collect()
            except (TypeError, ValueError) as error:
                raise Error(str(error), kind="bad_input", where=f"meshes.{name}") from error
            if mesh.subdivision is not None:
                keys.setdefault("subdivision", mesh.subdivision)
            if mesh.weld is not None:
                keys.setdefault("weld", mesh.weld)
        return self.convert(keys, f"meshes.{name}")

    def convert_object(self, value: Mapping[str, Any], place: str) -> Any:
        keys = dict(value)
        transform = keys.get("transform")
        if transform is not None:
            keys["transform"] = read_transform(transform, f"{place}.transform")
        return self.convert(keys, place)


def read_transform(value: Any, place: str) -> Any:
    """Keys of the scene file; a matrix (4, 4) becomes one of them."""
    if isinstance(value, Mapping):
        keys = dict(value)
        if "matrix" in keys and np.asarray(keys["matrix"]).ndim == 2:
            keys.update(read_transform(keys["matrix"], f"{place}.matrix"))
        return keys
    try:
        matrix = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"{place}: keys of the scene file or a matrix (4, 4) are needed, not {value!r:.60}") from None
    if matrix.shape != (4, 4):
        raise ValueError(f"{place}: the shape is {matrix.shape}, not (4, 4)")
    if not np.isfinite(matrix).all():
        raise ValueError(f"{place}: NaN or infinity in the matrix")
    return {"matrix": [float(x) for x in matrix.reshape(-1)]}


def strip_comments(text: str) -> str:
    """JSON without its comments: // to the end of a line, and /* */."""
    pattern = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', re.S)
    return pattern.sub(lambda found: found.group() if found.group().startswith('"') else " ", text)


def read_aspect(size: Any) -> float:
    """Width over height."""
    if isinstance(size, str) or np.ndim(size) != 1 or len(size) != 2:
        refuse(size, "size", "two whole numbers, width and height")
    width, height = (as_integer(side, "size", 1, MAX_PICTURE_SIZE) for side in size)
    return width / height


class Scene:
    """A scene. Each attribute has the keys of the scene file (docs/scene-file.md) and may be changed freely.

    camera, environment: parts, or None. materials, displacements, meshes: dicts of names to parts. objects, lights: lists.
    render: defaults of the picture (width, height, spp, bounces, seed). folder: what names of files are relative to."""

    def __init__(self) -> None:
        self.camera: Optional[dict[str, Any]] = None
        self.environment: Optional[dict[str, Any]] = None
        self.materials: dict[str, Any] = {}
        self.displacements: dict[str, Any] = {}
        self.meshes: dict[str, Any] = {}
        self.objects: list[dict[str, Any]] = []
        self.lights: list[dict[str, Any]] = []
        self.render: dict[str, Any] = {}
        self.folder = ""
        self._is_completed = False  # by from_mesh

    def clear(self) -> None:
        """Empties the scene, as a new one."""
        self.__init__()  # type: ignore[misc]

    # Reading and writing

    @classmethod
    def load(cls, file: Path) -> Scene:
        """Reads a scene file (.json). Meshes and pictures that it names are read when the scene is rendered."""
        path = os.fspath(file)
        scene = cls()
        try:
            with open(path, encoding="utf-8-sig") as stream:
                root = json.loads(strip_comments(stream.read()))
            if not _has_sections(root):
                raise ValueError("this is not a scene of version 1")
        except (OSError, ValueError, RecursionError):
            _relief.load_scene(path)  # says what is wrong, and where
            raise
        scene.folder = os.path.dirname(os.path.abspath(path))
        scene.camera = Camera(root["camera"]) if "camera" in root else None
        scene.environment = _fill(Environment(), root["environment"]) if "environment" in root else None
        scene.materials = {name: Material(keys) for name, keys in root.get("materials", {}).items()}
        scene.displacements = {name: _fill(Displacement(), keys) for name, keys in root.get("displacements", {}).items()}
        scene.meshes = root.get("meshes", {})
        scene.objects = root.get("objects", [])
        scene.lights = [Light(keys) for keys in root.get("lights", [])]
        scene.render = root.get("render", {})
        return scene

    @classmethod
    def from_mesh(cls, mesh: Union[Mesh, Path], displacement: Any = None, material: Any = None, environment: Any = None,
                  subdivision: Optional[Mapping[str, Any]] = None, preset: Optional[str] = None,
                  weld: Optional[float] = None) -> Scene:
        """A mesh with automatic camera and light. displacement: a Displacement, or a map: an array or a name of a file.
        preset: of the program that the map is from, as --preset of the command. weld: as of a Mesh. environment: a picture of the light (array or
        name); None: a studio with a key light, a fill and a rim."""
        scene = cls()
        name = None if isinstance(mesh, Mesh) else as_path(mesh, "mesh", "a Mesh, or the name of a file")
        keys: dict[str, Any] = {"file": mesh if name is None else os.path.abspath(name)}
        if subdivision is not None:
            keys["subdivision"] = dict(subdivision)
        if weld is not None:
            keys["weld"] = float(weld)
        if preset is not None:
            if displacement is None:
                raise Error("a preset is of a displacement, and there is none", where="preset")
            displacement = {**_make_displacement(displacement), "preset": preset}
        if environment is not None:
            is_part = isinstance(environment, Mapping)
            scene.environment = _fill(Environment(), environment) if is_part else Environment(_absolute(environment))
        scene.add(keys, displacement, material)
        parsed = scene._parse()
        parsed.complete()
        said = parsed.describe(len(scene.objects))
        scene.camera = Camera(said["camera"])
        sky = dict(scene.environment or {})
        if sky.get("file") is None:
            sky["file"] = parsed.environment_texels()
            scene._is_completed = True
        scene.environment = _fill(Environment(), {**sky, **said["environment"]})
        scene.lights = [Light(sun) for sun in said["suns"]]
        if material is None:
            scene.materials["clay"] = Material(said["last_object"]["material"])
            scene.objects[0]["material"] = "clay"
        return scene

    def save(self, folder: Path) -> None:
        """Writes scene.json, meshes (OBJ) and maps (EXR) into a folder. Of a scene that moves, scene.json has its keys, and the
        whole names of its numbered files and animated meshes, which stay where they are."""
        self._save_still(folder)
        scene = json.loads(self._collect()[0])
        if not is_moving(scene):
            return
        file = os.path.join(os.fspath(folder), "scene.json")
        with open(file, encoding="utf-8") as stream:
            saved = json.loads(strip_comments(stream.read()))
        put_motion(file, saved, scene, os.fspath(self.folder))

    def _save_still(self, folder: Path) -> None:
        """As it is at its first frame."""
        self._parse().save(os.fspath(folder))

    def validate(self) -> list[str]:
        """Reads the whole scene. Raises Error for what is wrong, and returns warnings of what looks wrong."""
        return self._parse().warnings

    # Changing

    def add(self, mesh: Any, displacement: Any = None, material: Any = None, transform: Any = None,
            name: Optional[str] = None, **keys: Any) -> str:
        """Adds an object, and those of its parts that the scene does not have yet. Returns its name.

        mesh: a Mesh, a name of a file, its keys, or the name of one in `meshes`; displacement and material likewise.
        transform: keys of the scene file, or a matrix (4, 4) for points as columns. keys: others of the object."""
        taken = {str(other.get("name")) for other in self.objects}
        entry: dict[str, Any] = {"name": _make_name(name or "object", taken)}
        entry["mesh"] = self._register(self.meshes, mesh, name or "mesh", is_named=True)
        if displacement is not None:
            is_known = isinstance(displacement, str) and displacement in self.displacements
            part = displacement if is_known else _make_displacement(displacement)
            entry["displacement"] = self._register(self.displacements, part, name or "displacement")
        if material is not None:
            entry["material"] = self._register(self.materials, material, name or "material")
        if transform is not None:
            entry["transform"] = transform
        entry.update(keys)
        self.objects.append(entry)
        return cast(str, entry["name"])

    @staticmethod
    def _register(section: dict[str, Any], part: Any, wanted: str, is_named: bool = False) -> str:
        if isinstance(part, str) and part in section:
            return part
        if isinstance(part, str) and not is_named:
            raise Error(f"there is no '{part}' in the scene", hint="known: " + ", ".join(section))
        for name, other in section.items():
            if other is part:
                return name
        name = _make_name(wanted, set(section))
        section[name] = {"file": _absolute(part)} if isinstance(part, (str, os.PathLike)) else part
        return name

    def aim(self, view: Optional[str] = None, from_: Any = None, to: Any = None, fov: Optional[float] = None,
            zoom: Optional[float] = None, frame_all: bool = False, env_rotate: Optional[float] = None,
            env_strength: Optional[float] = None, light: Any = None, ground: Union[bool, str] = False,
            size: tuple[int, int] = (1280, 720)) -> None:
        """Moves the camera and changes the light, as the options of `relief render` of these names do.

        view: front, back, left, right, top or three-quarter. from_, to: (x, y, z). fov: vertical, degrees. zoom: all so
        many times as large as the camera shows it now. env_rotate: degrees. light: suns in place of the scene's, a list of
        (azimuth, elevation), degrees. ground: True, a grey floor below all, or "shadow", a floor that shows the shadows on it
        and is clear elsewhere: with background="transparent" for compositing. size: of the picture to come. The studio that
        from_mesh chose follows the camera where nothing has changed it, and the floor has no horizon in it."""
        aspect = read_aspect(size)
        parsed = self._parse()
        suns = None if light is None else [light] if np.ndim(light) == 1 else list(light)
        parsed.aim({"view": view, "from_": from_, "to": to, "fov": fov, "zoom": zoom, "frame_all": frame_all,
                    "env_rotate": env_rotate, "env_strength": env_strength, "light": suns, "ground": ground}, aspect, self._is_completed)
        said = parsed.describe(len(self.objects))
        self.camera = Camera(said["camera"])
        if self.environment is not None:
            for key in ("strength", "rotate_degrees"):
                self.environment[key] = said["environment"][key]
        if suns is None and self._is_completed:
            for light, sun in zip([light for light in self.lights if light.get("type") == "sun"], said["suns"]):
                if not isinstance(light["direction"], Mapping):  # which has keys
                    light["direction"] = sun["direction"]
        if suns:
            others = [other for other in self.lights if other.get("type") != "sun"]
            self.lights = others + [Light(sun) for sun in said["suns"]]
        if said["object_count"] > len(self.objects) and ground:
            self._add_ground(said["last_object"])

    def _add_ground(self, said: Mapping[str, Any]) -> None:
        keys = {"shadow_catcher": True} if said["shadow_catcher"] else {}
        self.add(Mesh._from_arrays(said["mesh"]), material=Material(said["material"]), name=said["name"], **keys)

    # For the library

    def _collect(self, collector: Optional[Collector] = None) -> tuple[str, Collector]:
        """The text of a scene file, and what it names."""
        collector = collector or Collector()
        root: dict[str, Any] = {"version": 1}
        for key in ("render", "camera", "environment"):
            if getattr(self, key):
                root[key] = collector.convert(getattr(self, key), key)
        for key in ("materials", "displacements"):
            part = getattr(self, key)
            root[key] = {name: collector.convert(keys, f"{key}.{name}") for name, keys in part.items()}
        root["meshes"] = {name: collector.convert_mesh(mesh, name) for name, mesh in self.meshes.items()}
        root["objects"] = [collector.convert_object(entry, f"objects[{k}]") for k, entry in enumerate(self.objects)]
        root["lights"] = [collector.convert(light, f"lights[{k}]") for k, light in enumerate(self.lights)]
        return json.dumps(root), collector

    def _parse(self, frame: Optional[float] = None) -> _relief.Scene:
        text, collector = self._collect()
        return _relief.parse_scene(text, self.folder, collector.meshes, collector.textures, frame)

    def __repr__(self) -> str:
        return f"Scene({len(self.objects)} objects, {len(self.meshes)} meshes, {len(self.lights)} lights)"


def _has_sections(root: Any) -> bool:
    """Whether all sections are of the types that the parts of a scene are made of."""
    if not isinstance(root, dict) or set(root) - set(SECTIONS):
        return False
    version = root.get("version", 1)
    if isinstance(version, bool) or version != 1:
        return False
    one = [root.get(section, {}) for section in ("render", "camera", "environment", *NAMED_SECTIONS)]
    lists = [root.get(section, []) for section in ("objects", "lights")]
    named = [part for section in NAMED_SECTIONS for part in dict(root.get(section, {})).values()] \
        if all(isinstance(part, dict) for part in one) else [None]
    return all(isinstance(part, list) for part in lists) and all(isinstance(part, dict) for part in sum(lists, named))


def _fill(part: Any, keys: Mapping[str, Any]) -> Any:
    part.update(keys)
    return part


def _make_displacement(value: Any) -> Any:
    """Of a part, which stays the same object, or of a map: a name of a file, an array or tiles."""
    if isinstance(value, Mapping) and not _is_tiles(value):
        return value
    if is_array(value) and to_numpy(value, "displacement").ndim < 2:
        as_texels(value, "displacement")  # says what its shape is
    if not is_array(value) and not _is_tiles(value):
        as_path(value, "displacement", "a Displacement, an array, tiles, or the name of a file")
    return Displacement(_absolute(value))


def _is_tiles(value: Any) -> bool:
    return isinstance(value, Mapping) and bool(value) and all(isinstance(key, int) for key in value)


def _absolute(value: Any) -> Any:
    return os.path.abspath(os.fspath(value)) if isinstance(value, (str, os.PathLike)) else value


def _make_name(wanted: str, taken: set[str]) -> str:
    name, number = wanted, 2
    while name in taken:
        name, number = f"{wanted}_{number}", number + 1
    return name


Renderable = Union[Scene, Mesh, Path]


def as_scene(scene: Renderable) -> Scene:
    """Of a Scene, a Mesh, a scene file, or a mesh file."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, Mesh):
        return Scene.from_mesh(scene)
    path = as_path(scene, "scene", "a Scene, a Mesh, or the name of a file")
    return Scene.from_mesh(path) if _relief.is_mesh_file(path) else Scene.load(path)


def parse_any(scene: Renderable, frame: Optional[float] = None) -> _relief.Scene:
    """Of a Scene, a Mesh, a scene file, or a mesh file; at a frame, where values have keys. None: the first."""
    if frame is not None:
        frame = as_number(frame, "frame", *FRAMES)
    if isinstance(scene, Mesh):
        scene = Scene.from_mesh(scene)
    if isinstance(scene, Scene):
        return scene._parse(frame)
    path = as_path(scene, "scene", "a Scene, a Mesh, or the name of a file")
    return Scene.from_mesh(path)._parse(frame) if _relief.is_mesh_file(path) else _relief.load_scene(path, frame)
