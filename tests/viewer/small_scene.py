"""A scene that is there at once: a bumpy plane of four quads with a map of 64 x 64 texels."""
import json
import math
import pathlib
import struct
import zlib

SIDE = 64


def write_map(file):
    """A PNG of 16 bits: bumps along the normal."""
    rows = b""
    for y in range(SIDE):
        rows += b"\0"
        for x in range(SIDE):
            height = 0.5 + 0.4 * math.sin(0.5 * x) * math.sin(0.4 * y)
            rows += struct.pack(">HHH", 32768, 32768, int(65535 * height))

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 16, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_small_scene(folder):
    """scene.json, plane.obj and bumps.png."""
    folder = pathlib.Path(folder)
    lines = [f"v {x} {y} 0" for y in (-1, 0, 1) for x in (-1, 0, 1)]
    lines += [f"vt {x / 2} {y / 2}" for y in range(3) for x in range(3)]
    for first in (1, 2, 4, 5):
        lines.append("f " + " ".join(f"{k}/{k}" for k in (first, first + 1, first + 4, first + 3)))
    (folder / "plane.obj").write_text("\n".join(lines) + "\n")
    write_map(folder / "bumps.png")
    scene = {
        "version": 1,
        "camera": {"from": [0.8, -1.5, 3], "to": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 40},
        "environment": {"color": [0.6, 0.7, 0.9]},
        "lights": [{"type": "sun", "direction": [-1, -1, -2], "strength": 2}],
        "materials": {"clay": {"base_color": [0.7, 0.5, 0.4]}},
        "displacements": {"bumps": {"type": "vector", "file": "bumps.png", "space": "tangent", "axes": "t,b,n", "midlevel": 0.5,
                                    "scale": 0.4, "wrap": "clamp"}},
        "meshes": {"plane": {"file": "plane.obj"}},
        "objects": [{"name": "plane", "mesh": "plane", "displacement": "bumps", "material": "clay"}],
    }
    (folder / "scene.json").write_text(json.dumps(scene, indent=1))
