"""What the last final render of each scene took, and its report."""
_kept = {}


def keep(scene_name, statistics, lines):
    _kept[scene_name] = (dict(statistics), list(lines))


def find(scene_name):
    """(statistics, lines of the report) or None."""
    return _kept.get(scene_name)


def describe(statistics):
    """Pairs of a label and a text."""
    def mebibytes(key):
        return f"{statistics.get(key, 0) / 2 ** 20:.0f} MiB"
    rays = sum(statistics.get(key, 0) for key in ("camera_rays", "shadow_rays", "bounce_rays"))
    return [("Device", str(statistics.get("device") or statistics.get("engine", ""))),
            ("Prepared in", f"{statistics.get('prepare_s', 0):.2f} s"),
            ("First picture", f"{statistics.get('first_image_s', 0):.2f} s"),
            ("Rendered in", f"{statistics.get('render_s', 0):.2f} s"),
            ("Rays", f"{rays / 1e6:.1f} million"), ("Patches", f"{statistics.get('patches', 0):,}"),
            ("Instances", f"{statistics.get('instances', 0):,}"), ("Maps", mebibytes("displacement_bytes")),
            ("Trees", mebibytes("structures_bytes")), ("Cache", mebibytes("bottom_cache_bytes")),
            ("Peak of the process", mebibytes("peak_resident_bytes"))]


def clear():
    _kept.clear()
