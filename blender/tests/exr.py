"""Reads uncompressed EXR files of one part whose channels are 32-bit floats, as Blender writes them."""
import struct

import numpy as np
from relief_blender.exr_header import read_channels, read_text


def read_exr(path):
    """{channel: (height, width) float32}, row 0 at the top."""
    with open(path, "rb") as stream:
        stream.read(8)
        attributes = {}
        while name := read_text(stream):
            read_text(stream)
            attributes[name] = stream.read(struct.unpack("<i", stream.read(4))[0])
        assert attributes["compression"] == b"\0", "the file is compressed"
        channels = read_channels(attributes["channels"])
        assert {kind for kind, _, _ in channels.values()} == {2}, "32-bit floats are read alone"
        x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
        width, height = x1 - x0 + 1, y1 - y0 + 1
        stream.read(8 * height)
        rows = np.frombuffer(stream.read(), np.uint8).reshape(height, 8 + 4 * width * len(channels))
    texels = np.ascontiguousarray(rows[:, 8:]).view("<f4").reshape(height, len(channels), width)
    return {name: texels[:, i] for i, name in enumerate(sorted(channels))}
