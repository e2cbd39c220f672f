// Meshes as dicts of NumPy arrays, whose keys are the attributes of relief.Mesh.
#pragma once

#include <nanobind/nanobind.h>

#include "relief/scene.h"

namespace relief::python {

/// `arrays`: positions (N, 3) float32, sizes (F,) and corners (C,) uint32, and where there are some uvs (M,
/// 2), uv_indices (C,), normals (M, 3), normal_indices (C,), tangents (C, 4), creases (K, 2) uint32 and
/// sharpness (K,) float32; uv_set, a number, and further_uvs: a dict of (uvs, indices or None) by number. Uvs
/// without indices are one a corner: equal ones of a position become one.
Mesh make_mesh(const nanobind::dict& arrays);

/// The same keys, without copies, where there is something behind them.
nanobind::dict make_mesh_arrays(Mesh&& mesh);

} // namespace relief::python
