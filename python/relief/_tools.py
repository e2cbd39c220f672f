"""What scenes, meshes and maps are, and maps in other conventions."""
from __future__ import annotations

import os
from typing import Any, Mapping, Optional, Union, cast

from . import _relief
from ._arguments import as_integer
from ._arrays import as_path, is_array
from ._mesh import Mesh
from ._parts import Displacement
from ._scene import Scene

CONVENTION = ("type", "preset", "space", "axes", "frame", "lengths", "encoding", "midlevel", "scale", "flip_v")
DEFAULT_LEVEL = 5  # of meshes made of displaced surfaces
MAX_LEVEL = 12
KEPT = ("wrap", "dilate", "filter", "autobump")  # of a map whose texels are converted


def as_displacement(source: Any) -> Displacement:
    if isinstance(source, Displacement):
        return source
    if isinstance(source, Mapping) and "file" in source:
        made = Displacement()
        made.update(source)
        return made
    return Displacement(os.path.abspath(os.fspath(source)) if isinstance(source, (str, os.PathLike)) else source)


def parse_map(displacement: Mapping[str, Any]) -> _relief.Scene:
    scene = Scene()
    scene.displacements["map"] = displacement
    return scene._parse()


def is_map(source: Any) -> bool:
    if isinstance(source, (Mapping,)) or is_array(source):
        return True
    return isinstance(source, (str, os.PathLike)) and not _relief.is_mesh_file(os.fspath(source)) \
        and not os.fspath(source).lower().endswith(".json")


def as_mesh(mesh: Any) -> Optional[Mesh]:
    """What a map is for; a file is read."""
    if mesh is None or isinstance(mesh, Mesh):
        return mesh
    return Mesh.load(as_path(mesh, "mesh", "a Mesh, or the name of a file"))


def refuse_others(call: str, mesh: Any, keywords: Mapping[str, Any], known: str) -> None:
    """Keywords of another kind of source."""
    others = ([] if mesh is None else ["mesh"]) + list(keywords)
    if others:
        raise TypeError(f"{call} has no keyword '{others[0]}': {known}")


def inspect(source: Any, mesh: Union[Mesh, str, os.PathLike[str], None] = None, **settings: Any) -> dict[str, Any]:
    """What a scene, mesh or map is, and what is wrong with it: the keys of `relief inspect --json`, facts, values and findings.

    source: a Scene, a Mesh, a Displacement or an array of texels, or the file of one. mesh: what a map is for.
    settings: of a scene, those of render(), which its cost is estimated for."""
    if isinstance(source, Mesh):
        refuse_others("inspect() of a mesh", mesh, settings, "there is none")
        return _add_warnings(_relief.inspect_mesh(source._collect()), source)
    if isinstance(source, Scene):
        refuse_others("inspect() of a scene", mesh, {}, "settings of render()")
        return _relief.inspect_scene(source._parse(), settings)
    if is_map(source):
        refuse_others("inspect() of a map", None, settings, "mesh")
        displacement, polygons = as_displacement(source), as_mesh(mesh)
        is_declared = any(key in displacement for key in CONVENTION)
        said = _relief.inspect_map(parse_map(displacement), is_declared, polygons._collect() if polygons else None)
        return _add_warnings(said, polygons, "mesh: ") if polygons else said
    path = as_path(source, "source", "a Scene, a Mesh, a map, or the name of a file")
    if _relief.is_mesh_file(path):
        return inspect(Mesh.load(path), mesh, **settings)
    refuse_others("inspect() of a scene", mesh, {}, "settings of render()")
    return _relief.inspect_scene(_relief.load_scene(path), settings)


def _add_warnings(said: dict[str, Any], mesh: Mesh, prefix: str = "") -> dict[str, Any]:
    """Puts those of the mesh before the other findings."""
    said["findings"][:0] = [{"severity": "warning", "code": "W-READ", "text": prefix + text} for text in mesh.warnings]
    return said


def convert(source: Any, mesh: Union[Mesh, str, os.PathLike[str], None] = None,
            level: Optional[int] = None, **to: Any) -> Union[Displacement, Mesh]:
    """A map in another convention, or the surface of a scene as a mesh.

    source: a Displacement (its keys say what it means now), with `to` the keys of the new one: space, axes, type, frame,
    lengths, midlevel, scale, flip_v, preset, encoding; what is not said is as a scene file has it, but a map stays in its space
    unless space, axes or a preset say another. mesh: needed between tangent and object space, or between tangent frames. The
    result is a Displacement with all keys of the convention (those that a preset stands for in its place) and an array
    (H, W, 3) of float32, with type="height" (H, W, 1), or one for each tile.
    Or a Scene, or the file of a scene or mesh: a Mesh of its displaced surfaces, 2^level x 2^level quads a patch; level 5 if none
    is given."""
    if not isinstance(source, (Scene, Mesh)) and is_map(source):
        if level is not None:
            raise TypeError("convert() of a map has no keyword 'level': that is for scenes and meshes")
        return _convert_map(as_displacement(source), as_mesh(mesh), to)
    refuse_others("convert() of a scene or mesh", mesh, to, "level")
    if isinstance(source, Mesh):
        source = Scene.from_mesh(source)
    from ._scene import parse_any
    level = DEFAULT_LEVEL if level is None else as_integer(level, "level", 0, MAX_LEVEL)
    return Mesh._from_arrays(parse_any(cast(Any, source)).displace(level))


def _convert_map(source: Displacement, mesh: Union[Mesh, None], to: dict[str, Any]) -> Displacement:
    unknown = [key for key in to if key not in CONVENTION]
    if unknown:
        raise TypeError(f"convert() has no keyword '{unknown[0]}': {', '.join(CONVENTION)}")
    tiles, is_udim, meaning, _ = _relief.convert_map(parse_map(source), to, mesh._collect() if mesh else None)
    made = Displacement(tiles if is_udim else tiles[1001])
    made.update({key: source[key] for key in KEPT if key in source})
    made.update(meaning)
    return made


def devices() -> list[dict[str, Any]]:
    """Devices of the Vulkan engine, in the order of their indices; empty without a driver."""
    return _relief.devices()


def material_inputs() -> list[dict[str, Any]]:
    """Returns one dict per input of materials, in the order of the documentation.

    "name": the key in scene files, which is OpenPBR's name. "alias": a shorter key that means the same, or None.
    "type": "number", "color", "flag" or "normal". "low", "high": limits, of a color those of each part; infinity if there is none.
    "default", "unit", "meaning". "is_textured": whether a texture can replace the value. "texture_key": a further key of that
    texture, or None. Thread-safe."""
    return _relief.material_inputs()


def isas() -> list[str]:
    """Instruction sets that this machine and this build have, the best first."""
    return _relief.isas()


def parse_frames(text: str) -> list[int]:
    """Numbers of frames: "1-100x2,150" is from 1 to 100 every second one, and 150."""
    return _relief.parse_frames(text)


def name_frame(pattern: Union[str, os.PathLike[str]], frame: int) -> str:
    """The file of a frame: `####` becomes its number; without, ".0001" comes before the extension."""
    return _relief.name_frame(os.fspath(pattern), frame)
