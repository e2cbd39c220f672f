"""Values of shader inputs as keys of a material of the scene file."""
from __future__ import annotations

import numpy as np

from .assets import TOKENS, has_alpha
from .shading import Network, Texture, is_texture, spread


class KeySetter:
    """Collects the keys of one material."""

    def __init__(self, network: Network) -> None:
        self.network, self.keys = network, {}
        self.placed: list = []  # (keys of a texture, name of its uvs or None)

    def emits(self) -> bool:
        emission = self.keys.get("emission")
        return isinstance(emission, dict) or (emission is not None and max(emission) > 0)

    def number(self, name: str, value, low: float = 0, high: float = 1) -> None:
        """A number or its texture; nothing where value is None."""
        if value is None:
            return
        if is_texture(value):
            self.texture(name, value.pick("r"), is_color=False)
            return
        value = float(np.array(value).reshape(-1)[0])
        if not low <= value <= high:
            self.network.note(f"{name} of {value:g} is taken as {min(max(value, low), high):g}")
        self.keys[name] = min(max(value, low), high)

    def plain_number(self, name: str, value, low: float = 0, high: float = 1) -> None:
        """A number that cannot have a texture."""
        if is_texture(value):
            self.network.note(f"texture of {name} is not taken over")
            return
        self.number(name, value, low, high)

    def color(self, name: str, value, high: float = 1) -> None:
        if value is None:
            return
        if is_texture(value):
            self.texture(name, value, is_color=True, high=high)
            return
        value = spread(value)[:3]
        if value.min() < 0 or value.max() > high:
            self.network.note(f"{name} of {value.round(4).tolist()} is cut at 0 and {high:g}")
        self.keys[name] = [float(c) for c in np.clip(value, 0, high)]

    def texture(self, name: str, texture: Texture, is_color: bool, high: float = 1) -> None:
        if texture.channel == "a" and not has_alpha(texture.file):
            if not is_color:  # without alpha it is 1 everywhere
                self.number(name, texture.scale[3] + texture.bias[3])
            return
        factor = texture.scale[:3] if is_color else texture.scale[:1]
        if (np.abs(texture.bias[:3] if is_color else texture.bias[:1]) > 1e-6).any():
            self.network.note(f"bias of the texture of {name} is left out")
        if factor.min() < 0 or factor.max() > high:
            self.network.note(f"scale of the texture of {name} is cut at 0 and {high:g}")
        factor = [float(f) for f in np.clip(factor, 0, high)]
        keys = self.place(texture)
        if set(factor) != {1.0}:
            keys["factor"] = factor[0] if len(set(factor)) == 1 else factor
        if texture.channel is not None and (is_color or texture.channel != "r"):
            keys["channel"] = texture.channel
        if texture.color_space is not None and (is_color or texture.color_space != "linear"):
            keys["color_space"] = texture.color_space
        self.keys[name] = keys

    def place(self, texture: Texture) -> dict:
        """Where a texture lies: the keys that all textures have."""
        keys = {"file": texture.file, **texture.keys}
        self.placed.append((keys, texture.place.uvs))
        if texture.wrap != "repeat" and not any(token in texture.file for token in TOKENS):
            keys["wrap"] = texture.wrap
        if not np.array_equal(texture.place.scale, [1, 1]):
            keys["uv_scale"] = [float(x) for x in texture.place.scale]
        if not np.array_equal(texture.place.offset, [0, 0]):
            keys["uv_offset"] = [float(x) for x in texture.place.offset]
        return keys

    def number_uv_sets(self, displaced: str | None) -> tuple:
        """(uvs of the mesh's own, those of its further uv sets in the order of their numbers from 1 on). The mesh's own are
        those of the displacement, else of the normal map, else of the first texture."""
        normal = self.keys.get("geometry_normal")
        names = [name for _, name in self.placed if name is not None]
        own = displaced or next((name for keys, name in self.placed if keys is normal), None) or next(iter(names), None)
        further: list = []
        for keys, name in self.placed:
            if name is None or name == own or not any(keys is value for value in self.keys.values()):
                continue
            if keys is normal:
                self.network.note(f"its normal map on uvs {name} is read on {own}, as its displacement is")
                continue
            if name not in further:
                further.append(name)
            keys["uv_set"] = further.index(name) + 1
        return own, tuple(further)

    def normal(self, value) -> None:
        """A texture of directions, as scale and bias make them of texels in [0, 1]."""
        if value is None or not is_texture(value):
            return
        scale, bias = value.scale[:3] / 2, value.bias[:3]
        if scale[2] <= 0 or abs(bias[2] + scale[2]) > 0.01 or abs(abs(scale[0]) - abs(scale[1])) > 1e-6 or scale[0] < 0:
            # Texels that nobody has scaled are those of a map whose reader knows what to do.
            if np.allclose(value.scale[:3], 1) and np.allclose(bias, 0):
                scale = np.ones(3)
            else:
                self.network.note("scale and bias of its normal map are taken as 2 and -1")
                scale = np.ones(3)
        keys = self.place(value)
        if scale[1] < 0:
            keys["flip_y"] = True
        if abs(scale[0] - 1) > 1e-6:
            keys["scale"] = float(scale[0])
        self.keys["geometry_normal"] = keys

    def emission(self, luminance, color) -> None:
        """Their product, of which one may be a texture."""
        if is_texture(luminance) and is_texture(color):
            self.network.note("luminance and colour of its emission are textures: the former is left out")
            luminance = 1.0
        if is_texture(luminance):
            luminance, color = color, luminance.pick("r")
        factor = spread(luminance)
        if is_texture(color):
            if factor[:3].max() > 0:
                self.texture("emission", color.times(factor), is_color=True, high=1e30)
            return
        product = factor[:3] * spread(color)[:3]
        if product.max() > 0:
            self.color("emission", product, high=1e30)
