"""What the last final render of each scene took, and its report. Forgotten with the file that the scenes are of."""
from typing import NamedTuple

import bpy

_kept = {}  # by session_uid: names may be those of another scene later


class Kept(NamedTuple):
    statistics: dict  # keys of `relief render --stats`, of the last view layer; empty after a fault
    lines: list       # of the report, of all view layers
    fault: str        # "" where there is a picture


def keep(scene, statistics, lines, fault=""):
    """`scene`: the original bpy.types.Scene, not the evaluated one."""
    _kept[scene.session_uid] = Kept(dict(statistics), list(lines), fault)


def find(scene):
    """The Kept of a scene, or None."""
    return _kept.get(scene.session_uid)


def describe(statistics):
    """Pairs of a label and a text, of the keys of `relief render --stats`."""
    def find(section, key):
        return statistics.get(section, {}).get(key, 0)

    def seconds(key):
        return f"{find('time_s', key):.2f} s"

    def mebibytes(key):
        return f"{find('memory_bytes', key) / 2 ** 20:.1f} MiB"
    return [("Device", str(find("device", "name") or "")), ("Prepared in", seconds("prepare")),
            ("First picture", seconds("first_image")), ("Rendered in", seconds("render")),
            ("Rays", f"{find('rays', 'total') / 1e6:.1f} million"), ("Patches", f"{find('scene', 'patches'):,}"),
            ("Triangles", f"{find('scene', 'triangles'):,}"), ("Instances", f"{find('scene', 'instances'):,}"),
            ("Maps", mebibytes("displacement")), ("Structures", mebibytes("structures")),
            ("Cache", mebibytes("bottom_cache")), ("Peak of the process", mebibytes("peak_resident"))]


@bpy.app.handlers.persistent
def _forget(*_):
    _kept.clear()


def register():
    bpy.app.handlers.load_post.append(_forget)


def unregister():
    bpy.app.handlers.load_post.remove(_forget)
    _kept.clear()
