"""Whether a mesh can be the cage of a subdivision surface."""
import numpy as np

from .mesh_arrays import count_places


def can_be_subdivided(arrays):
    """Each edge has one or two faces, which go along it in opposite ways, and the faces of a point are one fan.

    No two points are at one place: Relief takes them for one, Blender does not."""
    used = np.unique(arrays.corners)
    if count_places(arrays.positions[used]) < len(used):
        return False
    first = arrays.corners.astype(np.int64)
    starts = np.cumsum(arrays.sizes) - arrays.sizes
    following = np.arange(len(first)) + 1
    following[starts + arrays.sizes - 1] = starts
    second = first[following]
    if np.any(first == second):
        return False
    count = int(first.max(initial=0)) + 1
    edges = first * count + second
    if len(np.unique(edges)) != len(edges):
        return False
    return count_fans(first, second, edges, following, count) == len(np.unique(first))


def count_fans(first, second, edges, following, count):
    """How many fans of faces there are around all points together."""
    order = np.argsort(edges)
    opposite = second * count + first
    at = np.minimum(np.searchsorted(edges[order], opposite), len(edges) - 1)
    has_opposite = edges[order][at] == opposite
    ours, theirs = np.flatnonzero(has_opposite), order[at[has_opposite]]
    # Corners of one point in faces that share an edge: the start of ours and the end of theirs.
    a, b = ours, following[theirs]
    labels = np.arange(len(edges))
    while True:
        smaller = np.minimum(labels[a], labels[b])
        before = labels.copy()
        np.minimum.at(labels, a, smaller)
        np.minimum.at(labels, b, smaller)
        if np.array_equal(labels, before):
            return len(np.unique(labels))
