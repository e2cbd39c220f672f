"""Textures on another uv set than that of the mesh."""
import base64
import json
import pathlib
import tempfile
import unittest

import numpy as np

import relief
import scenes

FIRST = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
SECOND = np.array([[0.3, 0.1], [0.9, 0.4], [0.2, 0.8], [0.05, 0.5]], np.float32)


def make_plane(uvs, **keys):
    return relief.Mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2, 3]], uvs=uvs, **keys)


def make_scene(mesh, **keys):
    scene = relief.Scene.from_mesh(mesh)
    texture = {"file": np.random.default_rng(1).random((16, 16, 3), np.float32), **keys}
    scene.materials = {"paint": relief.Material(base_color=texture)}
    scene.objects[0]["material"] = "paint"
    return scene


def render(scene):
    return relief.render(scene, size=(48, 32), spp=1, bounces=1).array


class UvSets(unittest.TestCase):
    def test_pictures_are_those_of_exchanged_uvs(self):
        expected = render(make_scene(make_plane(SECOND)))
        for given in (SECOND, SECOND.astype(np.float64).tolist(), (SECOND[::-1], [[3, 2, 1, 0]])):
            mesh = make_plane(FIRST, further_uvs={1: FIRST, 3: given})
            np.testing.assert_array_equal(render(make_scene(mesh, uv_set=3)), expected)
            self.assertFalse(np.array_equal(render(make_scene(mesh)), expected))
            self.assertFalse(np.array_equal(render(make_scene(mesh, uv_set=1)), expected))
            mesh.further_uvs[3] = (FIRST, None)
            np.testing.assert_array_equal(render(make_scene(mesh, uv_set=3)), render(make_scene(make_plane(FIRST))))

    def test_what_does_not_fit_is_named(self):
        for words, sets in ((r"further_uvs\[1\]: 3, and there are 4 corners", {1: FIRST[:3]}),
                            (r"indices of further_uvs\[1\]: 3, and there are 4", {1: (FIRST, [0, 1, 2])}),
                            (r"further_uvs\[1\]: index 9", {1: (FIRST, [0, 1, 2, 9])}),
                            (r"further_uvs\[1\]: the shape", {1: np.zeros((4, 3))}),
                            (r"further_uvs\[1\]: NaN", {1: FIRST * np.nan}),
                            (r"further_uvs\[0\]: uvs are set 0", {0: FIRST}),
                            (r"further_uvs\[256\]: the number", {256: FIRST}),
                            (r"further_uvs\['a'\]: the number", {"a": FIRST})):
            with self.assertRaisesRegex(ValueError, words):
                make_plane(FIRST, further_uvs=sets)
        with self.assertRaisesRegex(relief.Error, "lies on uv set 2, and mesh 'mesh' has uv sets 0 and 1"):
            render(make_scene(make_plane(FIRST, further_uvs={1: SECOND}), uv_set=2))
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(relief.Error, "lies on uv set 1, and a scene is saved with OBJ"):
                make_scene(make_plane(FIRST, further_uvs={1: SECOND}), uv_set=1).save(folder)

    def test_sets_of_files_are_read_where_asked_for(self):
        positions = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
        turned = [np.stack([uvs[:, 0], 1 - uvs[:, 1]], 1) for uvs in (FIRST, SECOND)]
        data = b"".join(a.astype(np.float32).tobytes() for a in (positions, *turned)) + np.array([0, 1, 2, 0, 2, 3], np.uint16).tobytes()
        accessors = [{"bufferView": k, "componentType": 5126, "count": 4, "type": kind} for k, kind in enumerate(("VEC3", "VEC2", "VEC2"))]
        accessors.append({"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"})
        starts = (0, 48, 80, 112, 124)
        views = [{"buffer": 0, "byteOffset": a, "byteLength": b - a} for a, b in zip(starts, starts[1:])]
        part = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}, "indices": 3}
        document = {"asset": {"version": "2.0"}, "meshes": [{"primitives": [part]}], "bufferViews": views, "accessors": accessors,
                    "buffers": [{"byteLength": 124, "uri": "data:;base64," + base64.b64encode(data).decode()}]}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "two.gltf"
            file.write_text(json.dumps(document))
            self.assertEqual(relief.Mesh.load(file).further_uvs, {})
            mesh = relief.Mesh.load(file, further_uv_sets=[1, 2])
            other = relief.Mesh.load(file, uv_set=1, further_uv_sets=[0])
            self.assertEqual((mesh.uv_set, list(mesh.further_uvs), other.uv_set, list(other.further_uvs)), (0, [1], 1, [0]))
            np.testing.assert_array_equal(mesh.further_uvs[1][0][mesh.further_uvs[1][1]], other.uvs[other.uv_indices])
            expected = render(make_scene(mesh, uv_set=1))
            np.testing.assert_array_equal(render(make_scene(other, uv_set=1)), expected)
            np.testing.assert_array_equal(render(make_scene(other)), expected)
            np.testing.assert_array_equal(render(make_scene(other, uv_set=0)), render(make_scene(mesh)))


if __name__ == "__main__":
    unittest.main()
