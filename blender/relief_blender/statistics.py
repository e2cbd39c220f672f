"""What the last final render of each scene took, and its report."""
_kept = {}


def keep(scene_name, statistics, lines):
    _kept[scene_name] = (dict(statistics), list(lines))


def find(scene_name):
    """(statistics, lines of the report) or None."""
    return _kept.get(scene_name)


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


def clear():
    _kept.clear()
