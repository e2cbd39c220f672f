"""Pictures of scenes."""
from __future__ import annotations

import glob
import importlib.util
import json
import math
import os
from typing import Any, Callable, Mapping, Optional, Sequence, Union

from . import _relief
from ._arguments import as_number, as_bool, is_false, is_bool, refuse
from ._arrays import as_texels
from ._parts import Camera
from ._picture import Picture
from ._progress import Callback, open_progress
from ._scene import Path, Renderable, Scene, parse_any

PictureCallback = Callable[[Picture], Any]


def find_denoisers() -> list[str]:
    """Libraries of Open Image Denoise 2: that of RELIEF_OIDN, else those in installed packages, the newest first."""
    given = os.environ.get("RELIEF_OIDN")
    if given:
        return [given]
    found: list[str] = []
    for package in ("pyoidn", "oidn", "bpy"):
        spec = importlib.util.find_spec(package)
        for folder in (spec.submodule_search_locations or []) if spec else []:
            found += glob.glob(os.path.join(folder, "**", "libOpenImageDenoise.so.2*"), recursive=True)
    return sorted(found, reverse=True)


def choose_cache(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """With the file that keeps compiled kernels of a device, where none is named: that of the command."""
    made = dict(keywords)
    if made.get("engine") != "vulkan" or made.get("pipeline_cache") is not None:
        return made
    folder = os.environ.get("XDG_CACHE_HOME", "")
    if not os.path.isabs(folder):
        folder = os.path.join(os.path.expanduser("~"), ".cache")
    folder = os.path.join(folder, "relief")
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError:
        return made
    device = made.get("device")
    made["pipeline_cache"] = os.path.join(folder, f"pipelines-{_relief.version}-{'best' if device is None else device}")
    return made


def make_entries(keywords: Mapping[str, Any]) -> dict[str, str]:
    return {"relief:background": "transparent"} if keywords.get("background") == "transparent" else {}


def wrap_picture(on_picture: Optional[PictureCallback], entries: dict[str, str]) -> Optional[Callable[[_relief.Image], Any]]:
    if on_picture is None:
        return None
    if not callable(on_picture):
        raise TypeError(f"on_picture: {on_picture!r} is no function")
    function = on_picture
    return lambda image: not is_false(function(Picture(image, complete=False, entries=entries)))


def read_interval(value: Any) -> float:
    return as_number(value, "picture_interval", 0, math.inf, "a number of seconds, 0 or more")


def choose_denoisers(denoise: Any) -> Optional[list[str]]:
    """Libraries to try; None where nothing is to be denoised."""
    if is_bool(denoise):
        return find_denoisers() if denoise else None
    if not isinstance(denoise, (str, os.PathLike)):
        refuse(denoise, "denoise", "True, False, or the library or folder of Open Image Denoise 2")
    return [os.fspath(denoise)]


def finish(answer: tuple[Any, ...], entries: dict[str, str]) -> Picture:
    """The picture, or the exception that ended its render, with the picture so far as its attribute."""
    image, statistics, warnings, is_complete, samples, failure = answer
    picture = None if image is None else Picture(image, json.loads(statistics), warnings, is_complete, samples, entries)
    if failure is not None:
        failure.picture = picture
        raise failure
    if picture is None:
        from ._errors import Error
        raise Error("the render was stopped before every pixel had a sample", kind="failed")
    return picture


def render(scene: Renderable, *, size: Optional[tuple[int, int]] = None, spp: Optional[int] = None,
           bounces: Optional[int] = None, seed: Optional[int] = None, engine: Optional[str] = None,
           device: Optional[int] = None, threads: Optional[int] = None, layers: Union[Sequence[str], str, None] = None,
           crop: Optional[Sequence[int]] = None, background: Union[str, Sequence[float], None] = None,
           noise: Optional[float] = None, time_limit: Optional[float] = None, clamp_indirect: Optional[float] = None,
           detail_height: Optional[int] = None,
           level: Union[int, str, None] = None, pixel_error: Optional[float] = None, mode: Optional[str] = None,
           denoise: Union[bool, Path] = False, check_maps: bool = True, first_sample: Optional[int] = None,
           cache_mb: Optional[int] = None, frame: Optional[float] = None, progress: Union[bool, Callback, None] = None,
           on_picture: Optional[PictureCallback] = None, picture_interval: float = 0.5, release: bool = False,
           **more: Any) -> Picture:
    """Renders a Scene, a Mesh, or the file of a scene or mesh. Without the GIL: other threads of Python go on.

    size: width and height, pixels; (1280, 720) unless the scene says another. spp: samples a pixel, 64. bounces: path
    length, 4. seed: 0. engine: "cpu" or "vulkan". threads: 0, all cores. layers: names as of `relief render --layers`.
    crop: x0, y0, x1, y1, half open. background: linear (r, g, b) behind the objects, or "transparent".
    noise: no more samples where the error is below this share of the brightness. time_limit: seconds, preparation and
    denoising included. clamp_indirect: the most that one path adds to a colour after its first bounce, 10; 0: no limit.
    detail_height: rows of the picture that levels of detail are chosen for, its own if not given; previews with the height of the
    picture after them share its geometry.
    level: "auto", or 2^level cells a side of each patch. pixel_error: size of cells aimed at, pixels.
    mode: "direct" or "tessellated". denoise: True, or the library or folder of Open Image Denoise 2. first_sample: of a
    range of samples. check_maps: warn of maps whose values speak against what is said of them; a few hundredths of a second a
    map. cache_mb: cap of the cache of patch trees. frame: of values with keys and of files with `####`, may
    lie between two; the first of the scene's render.frames unless given; with motion blur where the camera has a "shutter".
    release: True, so that a Scene is emptied once it has been read, and its arrays are not held twice.
    more: lod, bounce_levels, leaf, isa, structure, traversal,
    method, bottom, pipeline_cache, as the options of `relief render`.

    progress: True for a bar, or a function of a Progress, which is called several times a second from the start on, also while
    the scene is prepared. on_picture: a function of the Picture so far, called as soon as
    every pixel has a sample and then every picture_interval seconds. Both are called by this thread; where they return
    False the render stops. Where they raise, it stops, and the exception has the picture so far as `picture`.

    Ctrl-C stops as well: the picture so far is returned, and is not `complete`. KeyboardInterrupt is raised where there is
    none, or Ctrl-C comes twice."""
    given = {"size": size, "spp": spp, "bounces": bounces, "seed": seed, "engine": engine, "device": device,
             "threads": threads, "layers": layers, "crop": crop, "background": background, "noise": noise,
             "time_limit": time_limit, "clamp_indirect": clamp_indirect, "detail_height": detail_height,
             "level": level, "pixel_error": pixel_error,
             "mode": mode, "first_sample": first_sample, "cache_mb": cache_mb, **more}
    keywords = choose_cache({key: value for key, value in given.items() if value is not None})
    entries = make_entries(keywords)
    denoisers, interval = choose_denoisers(denoise), read_interval(picture_interval)
    is_checked = as_bool(check_maps, "check_maps")
    parsed = parse_any(scene, frame)
    if as_bool(release, "release") and isinstance(scene, Scene):
        scene.clear()
    with open_progress(progress) as callback:
        answer = _relief.render(parsed, keywords, callback, wrap_picture(on_picture, entries), interval,
                                is_checked, denoisers is not None, denoisers or [])
    return finish(answer, entries)


VIEW_SETTINGS = {"size", "spp", "bounces", "seed", "noise", "time_limit", "clamp_indirect", "detail_height",
                 "background", "crop", "first_sample"}


class Session:
    """A scene that stays prepared while its displacement maps are edited and its camera moves: pictures after the first cost
    what changed.

    scene: as for render(). frame: of values with keys, at an instant. settings: the other keywords of render() except denoise
    and check_maps. Not for several threads at once."""

    def __init__(self, scene: Renderable, frame: Optional[float] = None, **settings: Any) -> None:
        keywords = choose_cache({key: value for key, value in settings.items() if value is not None})
        self._keywords = keywords
        self._entries = make_entries(keywords)
        self._session = _relief.Session(parse_any(scene, frame), keywords)

    def change_view(self, camera: Optional[Camera] = None, **settings: Any) -> None:
        """The next picture is of another camera (None: the same), or has other settings of the image: size, spp, bounces, seed,
        noise, time_limit, clamp_indirect, detail_height, background, crop, first_sample; None sets one back. All of it is traced
        anew; trees stay where the levels of surfaces do."""
        others = sorted(set(settings) - VIEW_SETTINGS)
        if others:
            raise TypeError(f"change_view() changes the camera and the image, not {', '.join(others)}: begin another Session")
        keywords = {key: value for key, value in {**self._keywords, **settings}.items() if value is not None}
        parsed = None
        if camera is not None:
            scene = Scene()
            scene.camera = camera
            parsed = parse_any(scene)
        self._session.change_view(parsed, keywords)
        self._keywords, self._entries = keywords, make_entries(keywords)

    def edit(self, displacement: str, texels: Any, x: int = 0, y: int = 0, udim: int = 1001) -> int:
        """Replaces texels of a map from column x and row y on, row 0 at the top; (H, W) or (H, W, C), in the encoding of the
        map. Returns how many patches changed."""
        patches, _ = self._session.edit(displacement, as_texels(texels, "texels"), x, y, udim)
        return patches

    def render(self, progress: Union[bool, Callback, None] = None, on_picture: Optional[PictureCallback] = None,
               picture_interval: float = 0.5) -> Picture:
        """The next picture. Callbacks as those of render(); they cannot edit."""
        with open_progress(progress) as callback:
            interval = read_interval(picture_interval)
            answer = self._session.render(callback, wrap_picture(on_picture, self._entries), interval)
        return finish(answer, self._entries)
