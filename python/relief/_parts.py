"""Parts of a scene: dicts with the keys of the scene file, made by keywords and changed freely afterwards.

Wherever the scene file names a picture, an array (H, W) or (H, W, C) can stand: uint8 and uint16 as in integer files,
float16 or float32; row 0 is at the top. Tiles are a dict of UDIM numbers to arrays. All keys are listed in
docs/scene-file.md."""
from __future__ import annotations

from typing import Any


class Part(dict[str, Any]):
    """Keys of a section of the scene file. A keyword with an underscore at its end is the key without it."""

    def __init__(self, *given: Any, **keys: Any) -> None:
        super().__init__(*given)
        self.update({key[:-1] if key.endswith("_") else key: value for key, value in keys.items() if value is not None})

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a {type(self).__name__} has keys: write part['{name}'] = ... in place of part.{name} = ...")

    def __repr__(self) -> str:
        return f"{type(self).__name__}({super().__repr__()})"


class Camera(Part):
    """Camera(from_=(x, y, z), to=(x, y, z), up=(0, 1, 0), fov_degrees=35, aperture_radius=0, focus_distance=..., shutter=(0, 0)).

    fov_degrees: vertical, in degrees. aperture_radius, focus_distance: scene units; a radius of 0 is a pinhole. shutter: open
    and closed, frames from that of the picture; values with keys are blurred by their motion between."""


class Light(Part):
    """Light(type="sun", direction=(x, y, z), strength=1, ...): sun, point, rectangle, disk or spot.

    strength: of a sun the irradiance at normal incidence, of others radiant intensity. color: linear Rec.709."""


class Material(Part):
    """Material(base_color=(r, g, b), specular_roughness=0.5, base_metalness=0, ...): names of OpenPBR 1.1.

    An input may be a number or colour, an array, or {"file": array or name, "factor": ..., "wrap": ..., "uv_set": ...}."""


class Environment(Part):
    """Environment(file=name or array (H, W, 3), strength=1, rotate_degrees=0), or Environment(color=(r, g, b)).

    A latitude-longitude picture of radiance, linear; its centre is seen along -z."""

    def __init__(self, file: Any = None, **keys: Any) -> None:
        super().__init__(file=file, **keys)


class Displacement(Part):
    """Displacement(file, space="tangent", axes="t,b,n", midlevel=0, scale=1, type="vector", ...).

    file: name of a picture, array (H, W) of heights or (H, W, 3) of vectors, or {udim: array}. A texel displaces by
    (value - midlevel) * scale, in scene units, along the axes that its channels stand for."""

    def __init__(self, file: Any = None, **keys: Any) -> None:
        super().__init__(file=file, **keys)
