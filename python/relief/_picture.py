"""Pictures that were rendered or read."""
from __future__ import annotations

import os
import tempfile
from typing import Any, Optional, Sequence, Union

from . import _relief
from ._arguments import as_number, as_word
from ._arrays import Array, as_path
from ._errors import Error

TONEMAPS = ("agx", "aces", "filmic", "standard", "raw")
MOST_STOPS = 64  # either way


def describe_display(tonemap: str, exposure: Union[float, str]) -> dict[str, str]:
    """Entries of a header."""
    stops = exposure if isinstance(exposure, str) and exposure == "auto" else as_number(
        exposure, "exposure", -MOST_STOPS, MOST_STOPS, f'"auto", or a number of stops from {-MOST_STOPS} to {MOST_STOPS}')
    return {"relief:display": as_word(tonemap, "tonemap", TONEMAPS), "relief:exposure": str(stops)}


class Picture:
    """A picture with named channels; row 0 is at the top.

    array: (H, W, C) float32, linear Rec.709, premultiplied by A; the library's own memory.
    channels: names of the C channels: "R", "G", "B", "A", "depth.Z", "N.X", ...
    picture["depth"]: (H, W), picture["N"]: (H, W, 3), a layer without a copy; picture["R"] a channel.
    window: x0, y0, x1, y1 of the array within the whole picture of `full_size`, pixels.
    complete: False where the render was stopped. samples: of every pixel. statistics: the keys of `relief render --stats`.
    warnings: what of the scene looks like a mistake."""

    def __init__(self, image: _relief.Image, statistics: Optional[dict[str, Any]] = None, warnings: Sequence[str] = (),
                 complete: bool = True, samples: int = 0, entries: Optional[dict[str, str]] = None) -> None:
        self._image = image
        self._entries = dict(entries or {})
        self.array: Array = image.array()
        self.channels: list[str] = image.channels
        self.statistics: dict[str, Any] = statistics or {}
        self.warnings: list[str] = list(warnings)
        self.complete = complete
        self.samples = samples

    @classmethod
    def load(cls, file: Union[str, os.PathLike[str]]) -> Picture:
        """Reads a picture with all of its channels."""
        return cls(_relief.read_image(os.fspath(file)))

    def __getitem__(self, layer: str) -> Array:
        found = [k for k, name in enumerate(self.channels) if name == layer or name.startswith(layer + ".")]
        if not found:
            layers = dict.fromkeys(name.rsplit(".", 1)[0] for name in self.channels)
            raise KeyError(f"there is no layer '{layer}': {', '.join(layers)}")
        if len(found) == 1:
            return self.array[:, :, found[0]]
        return self.array[:, :, found[0] : found[-1] + 1]

    def __contains__(self, layer: object) -> bool:
        return any(name == layer or name.startswith(f"{layer}.") for name in self.channels)

    @property
    def color(self) -> Array:
        """(H, W, 4) red, green, blue and alpha, linear, premultiplied."""
        first = self.channels.index("R")
        return self.array[:, :, first : first + 4]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the array, pixels."""
        return int(self.array.shape[1]), int(self.array.shape[0])

    @property
    def window(self) -> tuple[int, int, int, int]:
        return self._image.window

    @property
    def full_size(self) -> tuple[int, int]:
        return self._image.full_size

    @property
    def metadata(self) -> dict[str, str]:
        """Entries of the header of an EXR file."""
        return self._image.metadata

    def save(self, file: Union[str, os.PathLike[str]], tonemap: str = "agx", exposure: Union[float, str] = 0) -> None:
        """Writes .exr with all channels, .hdr, or .png with the display transform `tonemap` (agx, aces, filmic, standard, raw) and
        `exposure` in stops, -64 to 64, or "auto". The file is replaced atomically."""
        path, display = as_path(file, "file", "the name of a file"), describe_display(tonemap, exposure)
        self._image.save(path, {**self._entries, **(display if path.lower().endswith(".png") else {})})

    def to_png(self, path: Union[str, os.PathLike[str], None] = None, tonemap: str = "agx",
               exposure: Union[float, str] = 0) -> bytes:
        """The bytes of a PNG file, which is also written to `path`, a name that ends in .png, if one is given."""
        if path is not None and not as_path(path, "path", "the name of a file").lower().endswith(".png"):
            raise Error(f"'{os.fspath(path)}' does not end in .png", where="path",
                        hint="save() writes other kinds of files")
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "picture.png") if path is None else os.fspath(path)
            self.save(file, tonemap, exposure)
            with open(file, "rb") as stream:
                return stream.read()

    def _repr_png_(self) -> bytes:
        return self.to_png()

    def __repr__(self) -> str:
        state = "" if self.complete else ", stopped early"
        return f"Picture({self.size[0]}x{self.size[1]}, {len(self.channels)} channels, {self.samples} samples{state})"
