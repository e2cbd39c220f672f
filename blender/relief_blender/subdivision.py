"""A subdivision surface modifier as Relief's `subdivision`: its cage, and the keys."""
from contextlib import contextmanager

import numpy as np

from . import mesh_arrays, mesh_repair

SHARP = 10  # sharpness of what stays a corner for ever


def find_modifier(evaluated, depsgraph):
    """The last enabled modifier if it is a Catmull-Clark or adaptive subdivision surface, else None."""
    is_render = depsgraph.mode == "RENDER"
    if evaluated.type != "MESH":
        return None
    shown = [m for m in evaluated.modifiers if (m.show_render if is_render else m.show_viewport)]
    if not shown or shown[-1].type != "SUBSURF":
        return None
    modifier = shown[-1]
    if is_adaptive(evaluated, modifier):
        return modifier
    is_smooth = modifier.subdivision_type == "CATMULL_CLARK" and find_level(modifier, depsgraph) > 0
    return modifier if is_smooth else None


def find_level(modifier, depsgraph):
    """The level that Blender subdivides to, at most that of Simplify; 0 is the mesh itself."""
    is_render, render = depsgraph.mode == "RENDER", depsgraph.scene.render
    level = modifier.render_levels if is_render else modifier.levels
    if not render.use_simplify:
        return level
    return min(level, render.simplify_subdivision_render if is_render else render.simplify_subdivision)


def is_adaptive(evaluated, modifier):
    """Cycles' adaptive subdivision: of the modifier from Blender 5.0 on, before of the object."""
    if hasattr(modifier, "use_adaptive_subdivision"):
        return modifier.use_adaptive_subdivision
    cycles = getattr(evaluated.original, "cycles", None)
    return bool(cycles and getattr(cycles, "use_adaptive_subdivision", False))


def is_own_cage(evaluated, depsgraph):
    """Whether the cage is the mesh of the object as the file has it: nothing is done to it before it is subdivided."""
    original, is_render = evaluated.original, depsgraph.mode == "RENDER"
    shown = [m for m in original.modifiers if (m.show_render if is_render else m.show_viewport)]
    return len(shown) == 1 and original.data.shape_keys is None and not original.data.is_editmode


@contextmanager
def cage_of(evaluated, modifier, depsgraph):
    """The mesh below the modifier, all others applied."""
    if is_own_cage(evaluated, depsgraph):
        yield evaluated.original.data
        return
    shown = modifier.show_render, modifier.show_viewport
    modifier.show_render = modifier.show_viewport = False
    try:
        yield evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
    finally:
        evaluated.to_mesh_clear()
        modifier.show_render, modifier.show_viewport = shown


def choose_level(levels, adaptive, is_displaced):
    """The key `level`: adaptive and displaced surfaces get the patches that the picture needs, others the modifier's levels."""
    return "auto" if adaptive or is_displaced else min(levels, 8)


def make_keys(modifier, adaptive, levels, is_displaced):
    """The key `subdivision` of a mesh. levels: see find_level()."""
    return {"scheme": "catmark", "level": choose_level(levels, adaptive, is_displaced),
            "uv": "linear" if modifier.uv_smooth == "NONE" else "smooth",
            "boundary": "edge-only" if modifier.boundary_smooth == "ALL" else "edge-and-corner",
            "creases": bool(modifier.use_creases)}


def read_creases(modifier, cage, arrays, report):
    """(edges, sharpness) of a cage, whose MeshArrays are `arrays`, or None: it has none."""
    edges, sharpness = np.zeros((0, 2), np.int32), np.zeros(0, np.float32)
    if modifier.use_creases:
        edges, sharpness = mesh_arrays.read_creases(cage)
    if len(edges) > 0:
        count = len(edges)
        edges, sharpness = mesh_repair.select_creases((edges, sharpness), arrays)
        if len(edges) < count:
            report("creases that are not along an edge of a face are left out")
    loose = mesh_arrays.read_loose_points(cage)
    corners = np.intersect1d(loose, arrays.corners) if len(loose) else loose
    others = ~((edges[:, 0] == edges[:, 1]) & np.isin(edges[:, 0], corners))
    edges = np.concatenate([edges[others], np.stack([corners, corners], -1).astype(np.int32)])
    sharpness = np.concatenate([sharpness[others], np.full(len(corners), SHARP, np.float32)])
    return (edges, sharpness) if len(edges) else None


def report_differences(modifier, report):
    """What of the modifier's settings Relief does otherwise."""
    if modifier.uv_smooth in {"PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE", "SMOOTH_ALL"}:
        name = modifier.bl_rna.properties["uv_smooth"].enum_items[modifier.uv_smooth].name
        report(f'UV Smooth "{name}" of the subdivision is Keep Corners, Junctions')
    if not modifier.use_limit_surface:
        report("the subdivision surface is its limit surface")
