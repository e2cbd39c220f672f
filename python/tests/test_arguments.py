"""Arguments that cannot be meant are refused with their names and values, and none is ignored."""
import math
import tempfile
import unittest

import numpy as np

import relief
import scenes

POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]


class ArgumentsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.scene = scenes.make_scene()
        cls.map = relief.Displacement(scenes.make_waves(), space="tangent", midlevel=0)

    def check(self, call, *cases, error=relief.Error):
        """cases: pairs of words of the message and keywords."""
        for words, keys in cases:
            with self.subTest(words), self.assertRaisesRegex(error, words):
                call(**keys)

    def test_renders(self):
        self.check(lambda **keys: relief.render(self.scene, **keys),
                   ("check_maps: 1 is not True or False", dict(check_maps=1)), ("check_maps: 'no'", dict(check_maps="no")),
                   ("picture_interval: 'x' is not", dict(picture_interval="x")),
                   ("picture_interval: -1 is not", dict(picture_interval=-1)),
                   ("picture_interval: nan is not", dict(picture_interval=math.nan)),
                   ("denoise: None is not True, False, or", dict(denoise=None)), ("denoise: 1 is not", dict(denoise=1)),
                   ("frame: 'a' is not a number", dict(frame="a")), ("frame: nan is not a number", dict(frame=math.nan)))
        self.check(relief.Session(self.scene).render, ("picture_interval: -1 is not", dict(picture_interval=-1)))
        relief.render(self.scene, check_maps=np.bool_(False), denoise=np.bool_(False), picture_interval=math.inf, progress=np.bool_(False))

    def test_callbacks_stop_by_false_of_numpy_as_well(self):
        slow = dict(size=(320, 240), spp=64, bounces=4)
        for answer in (np.bool_(False), np.array([1, 2])[0] > 5):
            self.assertFalse(relief.render(self.scene, on_picture=lambda _: answer, **slow).complete)
            calls = []
            try:
                self.assertFalse(relief.render(self.scene, progress=lambda _: calls.append(0) or answer, **slow).complete)
            except relief.Error as stopped:  # before there was a picture
                self.assertIn("stopped", str(stopped))
            self.assertEqual(len(calls), 1)
        for answer in (None, 0, np.bool_(True), np.int64(0)):
            self.assertTrue(relief.render(self.scene, progress=lambda _: answer, on_picture=lambda _: answer).complete)

    def test_rays(self):
        intersector = relief.Intersector(self.scene)
        origin, direction = [[0, 0, 3]], [[0, 0, -1]]
        for call in (intersector.closest_hits, intersector.any_hits):
            self.check(lambda **keys: call(origin, direction, **keys), ("mask: -1 is not a whole number from 0", dict(mask=-1)),
                       ("mask: None is not", dict(mask=None)), ("mask: 4294967296 is not", dict(mask=2**32)))
            self.check(lambda **keys: call(origin, direction, **keys), ("t_max: numbers are needed", dict(t_max="a")),
                       ("t_min: numbers are needed", dict(t_min=None)), error=TypeError)
        self.check(lambda **keys: intersector.closest_hits(origin, direction, **keys),
                   ("attributes: 5 is no list of names: shading_normal", dict(attributes=5)), error=TypeError)
        self.check(lambda **keys: intersector.closest_hits(origin, direction, **keys),
                   (r"attributes: '\[1\]' is not one of", dict(attributes=[[1]])), error=ValueError)
        self.check(lambda **keys: relief.trees.compare(self.scene, scenes.make_rays(4), **keys),
                   ("repeats: 0 is not a whole number from 1", dict(repeats=0)))

    def test_meshes(self):
        self.check(lambda **keys: relief.Mesh(POINTS, **keys), ("faces: .* is needed, not None", dict(faces=None)),
                   (r"faces: .* not \[0, 1, 2\]", dict(faces=[0, 1, 2])),
                   ("creases: .* are needed, not 5", dict(faces=[[0, 1, 2]], creases=5)),
                   ("subdivision: .* is needed, not 'catmark'", dict(faces=[[0, 1, 2]], subdivision="catmark")), error=TypeError)
        self.assertEqual(relief.Mesh(POINTS, (face for face in [[0, 1, 2]])).faces.tolist(), [[0, 1, 2]])

    def test_views(self):
        self.check(self.scene.aim, ("size: 0 is not a whole number from 1", dict(size=(1, 0))), ("size: 5 is not two", dict(size=5)),
                   ("size: 'ab' is not two", dict(size="ab")))
        self.scene.aim(size=np.array([4, 3]))

    def test_inspect(self):
        plane = scenes.make_plane()
        self.check(lambda **keys: relief.inspect(self.map, **keys), ("a map has no keyword 'nonsense'", dict(nonsense=3)),
                   ("mesh: a Mesh, or the name of a file is needed, not int", dict(mesh=5)), error=TypeError)
        self.check(lambda **keys: relief.inspect(self.scene, **keys), ("a scene has no keyword 'mesh'", dict(mesh=plane)), error=TypeError)
        self.check(lambda **keys: relief.inspect(plane, **keys), ("a mesh has no keyword 'spp'", dict(spp=3)), error=TypeError)
        self.check(relief.inspect, ("source: .* is needed, not int", dict(source=5)), error=TypeError)
        with tempfile.TemporaryDirectory() as folder:
            plane.save(f"{folder}/plane.obj")
            self.check(lambda **keys: relief.inspect(f"{folder}/plane.obj", **keys), ("no keyword 'mesh'", dict(mesh=plane)),
                       ("no keyword 'spp'", dict(spp=3)), error=TypeError)

    def test_convert(self):
        for source in (self.scene, scenes.make_plane()):
            self.check(lambda **keys: relief.convert(source, **keys), ("no keyword 'space'", dict(space="object", nonsense=3)),
                       ("no keyword 'mesh'", dict(mesh=scenes.make_plane())), error=TypeError)
            self.check(lambda **keys: relief.convert(source, **keys), ("level: 'a' is not a whole number", dict(level="a")))
        self.check(lambda **keys: relief.convert(self.map, **keys), ("a map has no keyword 'level'", dict(level=3)), error=TypeError)
        self.check(lambda **keys: relief.convert(self.map, **keys), ("mesh: .* is needed, not int", dict(mesh=5)), error=TypeError)


if __name__ == "__main__":
    unittest.main()
