"""Scenes from objects and arrays are what their files say."""
import base64
import json
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import relief
import scenes
from relief._save import is_moving


class SceneTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def render(self, scene, **keys):
        return relief.render(scene, size=(48, 32), spp=1, bounces=1, **keys).array

    def test_arrays_and_saved_files_make_one_picture(self):
        scene = scenes.make_scene()
        scene.materials["clay"]["base_color"] = np.random.default_rng(1).random((8, 8, 3), np.float32)
        scene.save(self.folder)
        saved = relief.Scene.load(self.folder / "scene.json")
        np.testing.assert_array_equal(self.render(scene), self.render(saved))
        np.testing.assert_array_equal(self.render(scene), self.render(self.folder / "scene.json"))

    def test_the_weld_of_a_mesh_is_its_key(self):
        apart = 1.5e-5
        points = [[-1, 0, 0], [0, 0, 0], [0, 1, 0], [-1, 1, 0], [apart, 0, 0], [1, 0, 0], [1, 1, 0], [apart, 1, 0]]
        uvs = np.tile(np.float32([[0, 0], [1, 0], [1, 1], [0, 1]]), (2, 1))
        for weld, count in ((None, 8), (2e-5, 6)):
            mesh = relief.Mesh(points, [[0, 1, 2, 3], [4, 5, 6, 7]], uvs=uvs, weld=weld)
            scene = relief.Scene()
            scene.add(mesh, displacement=relief.Displacement(np.zeros((2, 2, 3), np.float32), space="object"))
            self.assertEqual(len(relief.convert(scene, level=0).positions), count)
            self.assertEqual(any("weld" in warning for warning in self.warn(scene)), weld is None)
            scene.save(self.folder / str(count))
            saved = relief.Scene.load(self.folder / str(count) / "scene.json")
            self.assertEqual([keys.get("weld") for keys in saved.meshes.values()], [weld])

    def warn(self, scene):
        scene.environment = relief.Environment()
        return relief.render(scene, size=(8, 8), spp=1, bounces=1).warnings

    def test_a_scene_that_moves_is_saved_with_its_motion(self):
        scene = scenes.make_scene()
        scene.camera = relief.Camera(from_={"keys": [[1, [0, 0, 4]], [3, [0, 0, 8]]]}, to=(0, 0, 0))
        scene.objects[0]["transform"] = {"translate": {"keys": [[1, [0, 0, 0]], [3, [1, 0, 0]]]}}
        scene.materials["clay"] = relief.Material(roughness={"keys": [[1, 0.9], [3, 0.1]]})
        scene.lights = [relief.Light(type="sun", direction=(0, -1, -1), strength={"keys": [[1, 1], [3, 4]]})]
        scene.render = {"frames": "1-3", "fps": 25}
        scene.save(self.folder / "keys")
        self.write_maps("height.{:04}.exr")
        numbered = scenes.make_scene()
        numbered.folder = str(self.folder)
        numbered.displacements["numbered"] = relief.Displacement("height.####.exr", type="height", scale=2)
        numbered.objects[0]["displacement"] = "numbered"
        numbered.save(self.folder / "files")
        for moving, name in ((scene, "keys"), (numbered, "files")):
            file = self.folder / name / "scene.json"
            pictures = [self.render(moving, frame=frame) for frame in (1, 2, 3)]
            self.assertFalse(np.array_equal(pictures[0], pictures[2]))
            for frame, picture in zip((1, 2, 3), pictures):
                np.testing.assert_array_equal(self.render(file, frame=frame), picture)
        root = json.loads((self.folder / "keys" / "scene.json").read_text())
        self.assertEqual((root["render"]["frames"], root["render"]["fps"]), ("1-3", 25))

    def write_maps(self, name, shape=(4, 4)):
        """Maps of three frames in the folder of the test."""
        for number in (1, 2, 3):
            values = np.full(shape, number / 8, np.float32)
            relief.Scene.from_mesh(scenes.make_plane(), values).save(self.folder / str(number))
            os.rename(self.folder / str(number) / "maps" / "displacement.exr", self.folder / name.format(number))

    def expect_saved_frames(self, scene, frames, message=""):
        for frame in frames:
            np.testing.assert_array_equal(self.render(self.folder / "saved" / "scene.json", frame=frame),
                                          self.render(scene, frame=frame), message)

    def test_two_marks_of_a_name_of_a_file_are_a_number(self):
        self.write_maps("height.{:02}.exr")
        scene = scenes.make_scene()
        scene.folder = str(self.folder)
        scene.displacements["numbered"] = relief.Displacement("height.##.exr", type="height", scale=2)
        scene.objects[0]["displacement"] = "numbered"
        scene.save(self.folder / "saved")
        self.expect_saved_frames(scene, (1, 3))
        self.assertFalse(np.array_equal(self.render(scene, frame=1), self.render(scene, frame=3)))
        for part, moves in (({"meshes": {"b": {"file": "body.##.obj"}}}, True),
                            ({"meshes": {"b": {"file": "body.#.obj"}}}, False),
                            ({"materials": {"m": {"roughness_texture": "r.###.exr"}}}, True),
                            ({"objects": [{"name": "wall ####", "mesh": "b"}]}, False)):
            self.assertEqual(is_moving(part), moves, part)

    def test_moving_textures_of_all_names_are_found_from_another_folder(self):
        self.write_maps("map.{:02}.exr", (4, 4, 3))
        for key, value in (("geometry_normal", "map.##.exr"), ("geometry_normal", {"file": "map.##.exr", "scale": 0.5}),
                           ("roughness_texture", "map.##.exr"),
                           ("base_color_texture", {"keys": [[1, "map.01.exr"], [2, "map.03.exr"]]})):
            scene = scenes.make_scene()
            scene.folder = str(self.folder)
            scene.materials["clay"] = relief.Material({key: value})
            scene.save(self.folder / "saved")
            self.expect_saved_frames(scene, (1, 2), f"{key}: {value}")

    def test_normal_maps_are_arrays_under_both_names(self):
        normals = np.random.default_rng(1).uniform(0.3, 1, (8, 8, 3)).astype(np.float32)
        pictures = []
        for keys in ({}, {"normal_texture": normals}, {"geometry_normal": normals}, {"geometry_normal": {"file": normals}}):
            scene = scenes.make_scene()
            scene.materials["clay"] = relief.Material(keys)
            pictures.append(self.render(scene))
        self.assertFalse(np.array_equal(pictures[0], pictures[1]))
        for picture in pictures[2:]:
            np.testing.assert_array_equal(picture, pictures[1])

    def test_comments_and_files_of_the_scene_are_read(self):
        scenes.make_scene().save(self.folder)
        file = self.folder / "scene.json"
        file.write_text("// a comment\n" + file.read_text().replace('"version": 1', '/* "x" */ "version": 1'))
        self.assertEqual(relief.Scene.load(file).meshes["mesh"]["file"], "meshes/mesh.obj")

    def test_faults_of_a_file_have_their_line(self):
        file = self.folder / "scene.json"
        file.write_text('{"version": 1,\n "camera": {"from": [0, 0, 1],}}')
        with self.assertRaises(relief.Error) as caught:
            relief.Scene.load(file)
        self.assertEqual(caught.exception.kind, "bad_input")
        self.assertIn("2", caught.exception.where)

    def test_files_of_other_types_and_versions_are_errors(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene.json"
            for root in ([], 5, {"version": 2}, {"version": "1"}, {"version": 1, "materials": []}, {"version": 1, "objects": {}},
                         {"version": 1, "camera": 5}, {"version": 1, "meshes": {"a": "b.obj"}}, {"version": 1, "lights": [5]}):
                file.write_text(json.dumps(root))
                with self.assertRaises(relief.Error, msg=str(root)):
                    relief.Scene.load(file)

    def test_unknown_keys_are_refused_with_a_suggestion(self):
        scene = scenes.make_scene()
        scene.materials["clay"]["specular_roughnes"] = 0.1
        with self.assertRaises(relief.Error) as caught:
            scene.validate()
        self.assertIn("specular_roughness", caught.exception.hint)
        self.assertIn("materials.clay", caught.exception.message)
        self.assertEqual(str(pickle.loads(pickle.dumps(caught.exception))), str(caught.exception))

    def test_keys_of_parts_are_no_attributes(self):
        with self.assertRaisesRegex(AttributeError, r"part\['fov_degrees'\]"):
            relief.Camera().fov_degrees = 5

    def test_uvs_of_points_are_refused_with_the_way_to_those_of_corners(self):
        points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        with self.assertRaisesRegex(ValueError, r"uvs\[faces.ravel\(\)\]"):
            relief.Mesh(points, [[0, 1, 2], [0, 2, 3]], uvs=np.zeros((4, 2)))

    def test_tiles_are_arrays_by_udim_numbers(self):
        plane = relief.Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], [[0, 1, 4, 3], [1, 2, 5, 4]],
                            uvs=[[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]], uv_indices=[[0, 1, 4, 3], [1, 2, 5, 4]])
        flat, raised = np.zeros((8, 8), np.float32), np.full((8, 8), 0.5, np.float32)
        scene = relief.Scene.from_mesh(plane, relief.Displacement({1001: flat, 1002: raised}, type="height", midlevel=0))
        rays = np.array([[0.5, 0.5, 3, 0, 0, 0, -1, 9], [1.5, 0.5, 3, 0, 0, 0, -1, 9]], np.float32)
        np.testing.assert_allclose(relief.Intersector(scene).closest_hits(rays).t, [3, 2.5], atol=1e-5)

    def test_the_studio_of_a_mesh_alone_follows_the_camera_until_it_is_changed(self):
        scene = relief.Scene.from_mesh(scenes.make_plane())
        front, turn = scene.lights[0]["direction"], scene.environment["rotate_degrees"]
        scene.aim(view="back", ground=True)
        back = scene.lights[0]["direction"]
        self.assertLess(front[0] * back[0] + front[2] * back[2], 0)
        self.assertNotEqual(scene.environment["rotate_degrees"], turn)
        self.assertEqual(scene.materials[scene.objects[-1]["material"]]["specular_ior"], 1)
        scene.lights[0]["direction"] = [1, 0, 0]
        scene.aim(view="left")
        self.assertEqual(scene.lights[0]["direction"], [1, 0, 0])

    def test_a_matrix_moves_an_object(self):
        scene = relief.Scene.from_mesh(scenes.make_plane())
        matrix = np.array([[2, 0.5, 0, 0], [0, 1, 0, 0], [0, 0, 1, -3], [0, 0, 0, 1]])
        scene.add("mesh", transform=matrix, name="moved")
        hits = relief.Intersector(scene).closest_hits([[2.2, 0.5, 5]], [[0, 0, -1]])
        self.assertEqual((float(hits.t[0]), int(hits.object[0])), (8.0, 1))
        with self.assertRaisesRegex(ValueError, r"\(3, 3\)"):
            scene.objects[1]["transform"] = np.eye(3)
            scene.validate()

    def test_parts_of_a_scene_are_shared(self):
        scene, plane, gold = relief.Scene(), scenes.make_plane(), relief.Material(base_color=(1, 0.8, 0.3), base_metalness=1)
        names = [scene.add(plane, material=gold, transform={"translate": [2 * k, 0, 0]}) for k in range(3)]
        self.assertEqual((len(scene.meshes), len(scene.materials), names), (1, 1, ["object", "object_2", "object_3"]))
        scene.validate()

    def test_lights_environment_and_camera_have_the_keys_of_the_file(self):
        scene = scenes.make_scene()
        scene.camera = relief.Camera(from_=(0, 0, 4), to=(0, 0, 0), fov_degrees=np.float32(40))
        scene.environment = relief.Environment(np.ones((4, 8, 3), np.float32), strength=0.5)
        scene.lights = [relief.Light(type="point", position=np.array([0, 0, 2.0]), strength=3)]
        self.assertGreater(self.render(scene)[:, :, :3].mean(), 0.1)
        scene.lights[0]["kind"] = "x"
        with self.assertRaises(relief.Error):
            scene.validate()

    def test_numbers_that_are_none_are_named(self):
        for camera in ({"from": (0, np.nan, 1)}, {"from": np.array([0, np.inf, 1])}, {"from": (0, 0, {1})}):
            scene = scenes.make_scene()
            scene.camera = camera
            with self.assertRaisesRegex((ValueError, TypeError), r"camera.from\[[12]\]: "):
                scene.validate()

    def test_aim_does_what_the_options_do(self):
        scene = scenes.make_scene()
        scene.aim(view="front", light=[(30, 40), (100, 20)], ground="shadow", env_strength=0.5)
        self.assertEqual([light["type"] for light in scene.lights], ["sun", "sun"])
        self.assertEqual(scene.environment["strength"], 0.5)
        self.assertTrue(scene.objects[-1]["shadow_catcher"])
        self.render(scene, background="transparent")
        scene.aim(from_=(1, 2, 3), fov=50)
        self.assertEqual((scene.camera["from"], scene.camera["fov_degrees"]), ([1, 2, 3], 50))
        with self.assertRaisesRegex(relief.Error, "frame_all.*True or False"):
            scene.aim(frame_all=np.zeros(2))
        scene.aim(zoom=2)
        self.assertAlmostEqual(np.tan(np.radians(scene.camera["fov_degrees"] / 2)), np.tan(np.radians(25)) / 2, 5)

    def test_a_mesh_file_renders_as_it_is(self):
        scenes.make_plane().save(self.folder / "plane.obj")
        loaded = relief.Mesh.load(self.folder / "plane.obj")
        np.testing.assert_array_equal(loaded.positions, scenes.make_plane().positions)
        self.assertEqual(self.render(self.folder / "plane.obj").shape, (32, 48, 4))
        np.testing.assert_array_equal(self.render(self.folder / "plane.obj"), self.render(relief.Scene.from_mesh(loaded)))


class MeshTest(unittest.TestCase):
    def test_faces_come_in_three_forms(self):
        points = np.random.default_rng(1).random((5, 3))
        faces = [[0, 1, 2, 3], [0, 1, 4]]
        a = relief.Mesh(points, faces)
        b = relief.Mesh(points, (np.array([4, 3]), np.array([0, 1, 2, 3, 0, 1, 4])))
        np.testing.assert_array_equal(a.corners, b.corners)
        np.testing.assert_array_equal(a.sizes, b.sizes)
        self.assertEqual([list(face) for face in a.faces], faces)
        self.assertEqual(relief.Mesh(points, np.array([[0, 1, 2]])).faces.shape, (1, 3))

    def test_what_of_a_file_is_not_read_is_told(self):
        data = np.concatenate([np.eye(3).reshape(-1), [0, 0, 1, 0, 0, 1]]).astype(np.float32).tobytes()
        views = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}]
        document = {"asset": {"version": "2.0"}, "nodes": [{"name": "body", "mesh": 0, "skin": 0}], "skins": [{"joints": [0]}],
                    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]}], "bufferViews": views,
                    "accessors": [{"bufferView": k, "componentType": 5126, "count": 3, "type": f"VEC{3 - k}"} for k in (0, 1)],
                    "scenes": [{"nodes": [0]}], "scene": 0,
                    "buffers": [{"byteLength": 60, "uri": "data:;base64," + base64.b64encode(data).decode()}]}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "skinned.gltf"
            file.write_text(json.dumps(document))
            mesh = relief.Mesh.load(file)
            self.assertEqual(len(mesh.warnings), 1)
            self.assertIn("node 'body' would be bent by a skin", mesh.warnings[0])
            self.assertEqual(relief.Scene.from_mesh(file).validate(), mesh.warnings)
            first = {"severity": "warning", "code": "W-READ", "text": mesh.warnings[0]}
            self.assertEqual(relief.inspect(file)["findings"][0], first)
            of_map = relief.inspect(np.full((4, 4, 3), 0.1, np.float32), mesh=file)["findings"]
            self.assertIn({**first, "text": "mesh: " + first["text"]}, of_map)
        self.assertEqual(scenes.make_plane().warnings, [])

    def test_arrays_of_the_right_type_are_kept(self):
        points, faces = np.zeros((4, 3), np.float32), np.array([[0, 1, 2, 3]], np.uint32)
        mesh = relief.Mesh(points, faces)
        self.assertIs(mesh.positions, points)
        self.assertTrue(np.shares_memory(mesh.corners, faces))

    def test_uvs_of_corners_join_at_their_positions(self):
        quads = [[0, 1, 4, 3], [1, 2, 5, 4]]
        points = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]]
        corner_uvs = np.array(points, np.float32)[np.array(quads).reshape(-1), :2] / 2
        keys = dict(scheme="catmark", level=2)
        wave = np.random.default_rng(2).random((16, 16), np.float32)
        by_corner = relief.Mesh(points, quads, corner_uvs, subdivision=keys)
        by_index = relief.Mesh(points, quads, np.array(points)[:, :2] / 2, quads, subdivision=keys)
        rays = scenes.make_rays(500)
        t = [relief.Intersector(relief.Scene.from_mesh(mesh, relief.Displacement(wave, midlevel=0))).closest_hits(rays).t
             for mesh in (by_corner, by_index)]
        np.testing.assert_array_equal(*t)

    def test_creases_sharpen_a_subdivided_cube(self):
        corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        edges = sorted({tuple(sorted((quad[k], quad[k - 1]))) for quad in quads for k in range(4)})
        ray = [[0.9, 0.9, 5]], [[0, 0, -1]]

        def find(creases):
            mesh = relief.Mesh(corners, quads, creases=creases, subdivision={"scheme": "catmark", "level": 3})
            return float(relief.Intersector(relief.Scene.from_mesh(mesh)).closest_hits(*ray).t[0])

        self.assertEqual(find(None), np.inf)
        self.assertAlmostEqual(find([[a, b, 10] for a, b in edges]), 4, places=4)
        self.assertAlmostEqual(find((np.array(edges), np.full(len(edges), 10.0))), 4, places=4)

    def test_bad_arrays_are_named(self):
        quad = [[0, 1, 2, 3]]
        points = np.zeros((4, 3))
        for error, words, make in (
                (ValueError, r"positions: the shape is \(4, 2\)", lambda: relief.Mesh(np.zeros((4, 2)), quad)),
                (TypeError, "positions: numbers", lambda: relief.Mesh(np.array([["a", "b", "c"]]), quad)),
                (ValueError, "positions: NaN or infinity in row 1", lambda: relief.Mesh([[0, 0, 0], [0, np.nan, 0], [1, 1, 1]], [[0, 1, 2]])),
                (ValueError, "index 4 is out of range", lambda: relief.Mesh(points, [[0, 1, 2, 4]])),
                (ValueError, "index -1 is out of range", lambda: relief.Mesh(points, [[0, 1, 2, -1]])),
                (TypeError, "faces: integers", lambda: relief.Mesh(points, np.array([[0.0, 1, 2]]))),
                (ValueError, "2 corners, 3 are needed", lambda: relief.Mesh(points, [[0, 1]])),
                (ValueError, "sizes add up to 7", lambda: relief.Mesh(points, (np.array([4, 3]), np.arange(4)))),
                (ValueError, r"faces: the shape is \(2, 2, 2\)", lambda: relief.Mesh(points, np.zeros((2, 2, 2), int))),
                (ValueError, "uvs: 3, and there are 4 corners", lambda: relief.Mesh(points, quad, np.zeros((3, 2)))),
                (ValueError, "uv_indices: index 9", lambda: relief.Mesh(points, quad, np.zeros((4, 2)), [[0, 1, 2, 9]])),
                (ValueError, "uv_indices: there are no uvs", lambda: relief.Mesh(points, quad, None, [[0, 1, 2, 3]])),
                (ValueError, r"normals: the shape is \(4, 2\)", lambda: relief.Mesh(points, quad, normals=np.zeros((4, 2)))),
                (ValueError, r"tangents: the shape is \(4, 3\)", lambda: relief.Mesh(points, quad, tangents=np.zeros((4, 3)))),
                (ValueError, "creases: index 7", lambda: relief.Mesh(points, quad, creases=[[0, 7, 1]])),
                (ValueError, "creases: .*whole numbers", lambda: relief.Mesh(points, quad, creases=[[0, 1.5, 1]])),
                (ValueError, "sharpness of creases: NaN", lambda: relief.Mesh(points, quad, creases=[[0, 1, np.nan]])),
                (ValueError, r"displacement: the shape is \(8,\)", lambda: relief.Scene.from_mesh(scenes.make_plane(), np.zeros(8))),
                (TypeError, "displacement: a Displacement, .*, not int", lambda: relief.Scene.from_mesh(scenes.make_plane(), 5)),
                (TypeError, "mesh: a Mesh, .*, not Scene", lambda: relief.Scene.from_mesh(scenes.make_scene())),
                (relief.Error, "preset: ", lambda: relief.Scene.from_mesh(scenes.make_plane(), preset="zbrush"))):
            with self.assertRaisesRegex(error, words):
                make()

    def test_what_was_changed_is_checked_again(self):
        mesh = scenes.make_plane()
        scene = relief.Scene.from_mesh(mesh)
        mesh.corners = np.array([0, 1, 2, 9], np.uint32)
        with self.assertRaisesRegex(relief.Error, "^meshes.mesh: faces: index 9"):
            relief.render(scene)
        mesh = scenes.make_plane(creases=[[0, 1, 3]])
        mesh.creases = np.array([[0, 9]], np.int32)
        with self.assertRaisesRegex(relief.Error, "^meshes.mesh: creases: index 9"):
            relief.render(mesh)
        mesh = scenes.make_plane()
        mesh.positions[0, 0] = np.nan
        scene = relief.Scene()
        scene.add(mesh, name="head")
        with self.assertRaisesRegex(relief.Error, "^meshes.head: positions: NaN"):
            scene.validate()
        with self.assertRaisesRegex(TypeError, r"objects\[0\].transform: .* not 'a'"):
            scene = relief.Scene()
            scene.add(scenes.make_plane(), transform="a")
            scene.validate()

    def test_a_preset_says_what_a_map_of_a_program_means(self):
        scene = relief.Scene.from_mesh(scenes.make_plane(), scenes.make_waves(), preset="blender-brush")
        self.assertEqual(scene.displacements["displacement"]["preset"], "blender-brush")
        self.assertEqual(scene.validate(), relief.Scene.from_mesh(
            scenes.make_plane(), relief.Displacement(scenes.make_waves(), preset="blender-brush")).validate())
        with self.assertRaisesRegex(relief.Error, "unknown preset 'mudbocks'"):
            relief.Scene.from_mesh(scenes.make_plane(), scenes.make_waves(), preset="mudbocks")

    def test_other_orders_and_read_only_memory_are_taken(self):
        points = np.asfortranarray(np.array(scenes.make_plane().positions))
        points.flags.writeable = False
        mesh = relief.Mesh(points[:, ::1], np.array([[0, 1, 2, 3]])[::-1])
        np.testing.assert_array_equal(mesh.positions, points)
        self.assertEqual(relief.render(relief.Scene.from_mesh(mesh), size=(8, 8), spp=1).size, (8, 8))


class TextureTest(unittest.TestCase):
    def test_bad_maps_are_named(self):
        for error, words, array in ((TypeError, "displacements.m.file: texels are .* not int64", np.zeros((4, 4), np.int64)),
                                    (ValueError, r"the shape is \(4, 4, 5\)", np.zeros((4, 4, 5), np.float32)),
                                    (relief.Error, r"NaN in channel G", np.full((4, 4, 3), (0, np.nan, 0), np.float32)),
                                    (ValueError, r"the shape is \(0, 4, 1\)", np.zeros((0, 4), np.float32))):
            scene = relief.Scene.from_mesh(scenes.make_plane())
            scene.displacements["m"] = relief.Displacement(array)
            with self.assertRaisesRegex(error, words):
                scene.validate()

    def test_kinds_of_texels_mean_the_same(self):
        scene = scenes.make_scene()
        steps = np.random.default_rng(3).integers(0, 255, (16, 16, 3), np.uint8)
        rays = scenes.make_rays(300)

        def trace(array):
            scene.displacements["displacement"]["file"] = array
            return relief.Intersector(scene, level=3).closest_hits(rays).t

        scene.displacements["displacement"]["scale"] = 0.1
        floats = steps.astype(np.float32) * (np.float32(1) / np.float32(255))  # as readers of files do
        expected = trace(floats)
        np.testing.assert_array_equal(trace(steps), expected)
        np.testing.assert_array_equal(trace(floats.astype(np.float64)), expected)
        np.testing.assert_allclose(trace((steps / 255).astype(np.float16)), expected, atol=1e-3)
        transposed = np.ascontiguousarray(floats.transpose(1, 0, 2))
        np.testing.assert_array_equal(trace(transposed.transpose(1, 0, 2)), expected)


if __name__ == "__main__":
    unittest.main()
