"""Scenes that stay prepared between pictures while anything of them changes."""
from __future__ import annotations

import json
import os
import weakref
from typing import Any, Callable, Iterable, Mapping, NamedTuple, Optional, Union

from . import _relief
from ._arguments import as_number
from ._arrays import is_array
from ._mesh import Mesh
from ._parts import Camera
from ._picture import Picture
from ._progress import Callback, open_progress
from ._render import (VIEW_SETTINGS, PictureCallback, choose_cache, finish, make_entries, read_interval,
                      wrap_picture)
from ._scene import FRAMES, Collector, Renderable, Scene, as_scene, parse_any

WHOLE_FILES = (".obj", ".ply", ".glb", ".fbx")  # meshes that are in no file but their own

Reference = Callable[[], Any]


def refer(thing: Any) -> Reference:
    """Weakly where that can be, so that an array is not kept for being known."""
    try:
        return weakref.ref(thing)
    except TypeError:
        return lambda: thing


class Known(NamedTuple):
    """Something that was handed over. The objects that it was made of, and what else of it counts."""
    references: tuple[Reference, ...]
    plain: str

    def is_of(self, things: Iterable[Any], plain: str) -> bool:
        things = tuple(things)
        return self.plain == plain and len(things) == len(self.references) and \
            all(reference() is thing for reference, thing in zip(self.references, things))


class KnownPicture(NamedTuple):
    known: Known
    name: str
    textures: dict[str, Any]


class Memory:
    """What of the newest scene the library has."""

    def __init__(self) -> None:
        self.meshes: dict[str, Known] = {}
        self.pictures: dict[tuple[int, ...], KnownPicture] = {}
        self.count = 0  # names of pictures that were made up


def list_parts(mesh: Mesh) -> tuple[list[Any], str]:
    """The objects that a mesh is made of, and the rest as text."""
    things: list[Any] = [mesh, mesh.positions, mesh.sizes, mesh.corners, mesh.uvs, mesh.uv_indices, mesh.normals,
                         mesh.normal_indices, mesh.tangents, mesh.creases, mesh.sharpness]
    for number in sorted(mesh.further_uvs):
        things += mesh.further_uvs[number]
    return [thing for thing in things if thing is not None], \
        json.dumps([[thing is None for thing in things], mesh.uv_set, sorted(mesh.further_uvs)])


class HandOver(Collector):
    """Collects a scene, without what the library has of the one before."""

    def __init__(self, memory: Memory, folder: str) -> None:
        super().__init__()
        self._memory, self._folder = memory, folder
        self.kept: list[str] = []
        self.known = Memory()

    def make_name(self) -> str:
        self._memory.count += 1
        return f"memory:{self._memory.count}"

    def name_picture(self, value: Any, place: str) -> Optional[str]:
        is_tiles = isinstance(value, Mapping)
        things = tuple(value.values()) if is_tiles else (value,)
        if not all(is_array(thing) for thing in things) or not things:
            return super().name_picture(value, place)
        key, plain = tuple(id(thing) for thing in things), json.dumps([str(number) for number in value] if is_tiles else [])
        for memory in (self.known, self._memory):
            found = memory.pictures.get(key)
            if found is not None and found.known.is_of(things, plain):
                self.known.pictures[key] = found
                self.textures.update(found.textures)
                return found.name
        before = set(self.textures)
        name = super().name_picture(value, place)
        if name is not None:
            made = {other: _relief.Texture(self.textures[other], other) for other in self.textures if other not in before}
            self.textures.update(made)
            self.known.pictures[key] = KnownPicture(Known(tuple(map(refer, things)), plain), name, made)
        return name

    def convert_mesh(self, value: Any, name: str) -> Any:
        keys = dict(value) if isinstance(value, Mapping) else {"file": value}
        mesh = keys.pop("file", None)
        if isinstance(mesh, Mesh):
            things, plain = list_parts(mesh)
            keys.setdefault("subdivision", mesh.subdivision)
            keys.setdefault("weld", mesh.weld)
        else:
            things, plain = [], self._describe_file(mesh)
        plain += "\n" + json.dumps(self.convert(keys, f"meshes.{name}"), sort_keys=True)
        before = self._memory.meshes.get(name)
        if before is not None and before.is_of(things, plain):
            self.known.meshes[name] = before
            self.kept.append(name)
            return {"file": f"memory:{name}"}
        converted = super().convert_mesh(value, name)
        self.known.meshes[name] = Known(tuple(map(refer, things)), plain)
        return converted

    def _describe_file(self, file: Any) -> str:
        """What a file is known to be the same by; of a file that names others it is never the same."""
        try:
            path = os.path.join(self._folder, os.fspath(file))
            state = os.stat(path)
        except (OSError, TypeError, ValueError):
            return f"{os.urandom(16).hex()} "
        stamp = f"{path} {state.st_mtime_ns} {state.st_size} "
        return stamp if path.lower().endswith(WHOLE_FILES) else f"{os.urandom(16).hex()} "

    def commit(self) -> None:
        """The library has the scene."""
        self._memory.meshes, self._memory.pictures = self.known.meshes, self.known.pictures


class LiveScene:
    """A scene that stays prepared between pictures while its camera, its light, its objects or its meshes change.

        live = relief.LiveScene(scene, size=(320, 240), spp=4)
        live.render()
        scene.objects[0]["transform"] = {"translate": [0, 1, 0]}
        live.change_scene(scene)
        live.render()

    What is the same object as in the scene before is neither handed over nor prepared again: a Mesh with the same arrays, an
    array of texels, a file that has not changed since. Whoever writes to an array gives a new one, such as a copy, in its
    place. Pictures are those of render() bit for bit, but without motion blur: values with keys are those of `frame`.

    settings: the other keywords of render() except denoise, check_maps and mode="tessellated". progress: as of render(); where
    it returns False the preparation stops, with an Error whose kind is "failed". release: meshes of the scene lose their arrays
    once the library has them, and stand for what they were from then on. Not for several threads at once."""

    def __init__(self, scene: Renderable, frame: Optional[float] = None, progress: Union[bool, Callback, None] = None,
                 release: bool = False, **settings: Any) -> None:
        keywords = choose_cache({key: value for key, value in settings.items() if value is not None})
        self._keywords, self._release, self._memory = keywords, release, Memory()
        self._entries = make_entries(keywords)
        self._live: Any = None
        self._hand_over(scene, frame, progress, keywords)

    def change_scene(self, scene: Renderable, frame: Optional[float] = None, progress: Union[bool, Callback, None] = None,
                     **settings: Any) -> None:
        """The next picture is of another scene, which may be the one before, changed; settings as for change_view(). After an
        error the scene before is what the next one is compared with, but it is not rendered again without another change."""
        self._hand_over(scene, frame, progress, self._merge(settings, "change_scene"))

    def change_view(self, camera: Optional[Camera] = None, progress: Union[bool, Callback, None] = None, **settings: Any) -> None:
        """The next picture is of another camera (None: the same), or has other settings of the image: size, spp, bounces, seed,
        noise, time_limit, clamp_indirect, detail_height, background, crop, first_sample; None sets one back. Nothing is prepared
        again but surfaces that a nearer view asks for in other patches."""
        keywords = self._merge(settings, "change_view")
        parsed = None
        if camera is not None:
            scene = Scene()
            scene.camera = camera
            parsed = parse_any(scene)
        with open_progress(progress) as callback:
            self._live.change_view(parsed, keywords, callback)
        self._keywords, self._entries = keywords, make_entries(keywords)

    def render(self, progress: Union[bool, Callback, None] = None, on_picture: Optional[PictureCallback] = None,
               picture_interval: float = 0.5) -> Picture:
        """The next picture. Callbacks as those of render(); they change nothing of the scene."""
        with open_progress(progress) as callback:
            interval = read_interval(picture_interval)
            answer = self._live.render(callback, wrap_picture(on_picture, self._entries), interval)
        return finish(answer, self._entries)

    @property
    def made_surfaces(self) -> int:
        """How many surfaces have been made from meshes so far; objects that share a mesh and a displacement share one."""
        count: int = self._live.made_surfaces
        return count

    def _merge(self, settings: Mapping[str, Any], call: str) -> dict[str, Any]:
        others = sorted(set(settings) - VIEW_SETTINGS)
        if others:
            raise TypeError(f"{call}() changes the scene and the image, not {', '.join(others)}: begin another LiveScene")
        return {key: value for key, value in {**self._keywords, **settings}.items() if value is not None}

    def _hand_over(self, renderable: Renderable, frame: Optional[float], progress: Union[bool, Callback, None],
                   keywords: dict[str, Any]) -> None:
        scene = as_scene(renderable)
        hand_over = HandOver(self._memory, scene.folder)
        text, _ = scene._collect(hand_over)
        given = {"text": text, "folder": scene.folder, "meshes": hand_over.meshes, "textures": hand_over.textures,
                 "frame": None if frame is None else as_number(frame, "frame", *FRAMES)}
        with open_progress(progress) as callback:
            if self._live is None:
                self._live = _relief.LiveScene(given, keywords, callback)
            else:
                self._live.change_scene(given, hand_over.kept, keywords, callback)
        self._keywords, self._entries = keywords, make_entries(keywords)
        if self._release:
            self._release_meshes(scene, hand_over)
        hand_over.commit()

    @staticmethod
    def _release_meshes(scene: Scene, hand_over: HandOver) -> None:
        for name, value in scene.meshes.items():
            mesh = value.get("file") if isinstance(value, Mapping) else value
            if not isinstance(mesh, Mesh):
                continue
            keys = hand_over.known.meshes[name].plain.split("\n", 1)[1]
            mesh._let_go()
            things, plain = list_parts(mesh)
            hand_over.known.meshes[name] = Known(tuple(map(refer, things)), plain + "\n" + keys)
