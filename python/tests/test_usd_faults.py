"""relief.usd: what is wrong in a stage comes as relief.Error with file and prim, or is left out and reported."""
import math
import os
import tempfile
import unittest

import relief
import relief.usd

try:
    from pxr import Usd
except ImportError:
    Usd = None

SQUARE = """
point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
int[] faceVertexCounts = [4]
int[] faceVertexIndices = [0, 1, 2, 3]
"""


def make_prim(kind, name, *lines, inner=""):
    return f'def {kind} "{name}" {{\n' + "\n".join(lines) + f"\n{inner}\n}}\n"


def make_mesh(name, *lines, scheme="none"):
    return make_prim("Mesh", name, SQUARE, f'uniform token subdivisionScheme = "{scheme}"', *lines)


def add_uvs(file):
    return ("texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (\ninterpolation = \"vertex\"\n)",
            f"custom asset relief:displacement:file = @{file}@")


@unittest.skipIf(Usd is None, "usd-core is not installed: pip install relief[usd]")
class FaultTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "shot.usda")
        self.report = []

    def load(self, *prims, **options):
        with open(self.path, "w", encoding="utf-8") as file:
            file.write("#usda 1.0\n" + "\n".join(prims))
        self.report = []
        return relief.usd.load(self.path, report=self.report, **options)

    def check_refused(self, where, words, *prims, **options):
        """where: path of the prim, or nothing."""
        with self.subTest(where=where, words=words), self.assertRaisesRegex(relief.Error, words) as caught:
            self.load(*prims, **options)
        if where:
            self.assertEqual((caught.exception.kind, caught.exception.where), ("bad_input", f"{self.path}: {where}"))

    def check_reported(self, path, text):
        self.assertTrue(any(line.startswith(f"{path}: ") and text in line for line in self.report), self.report)

    def write_map(self):
        plane = relief.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], uvs=[[0, 0], [1, 0], [0, 1]])
        relief.render(plane, size=(8, 8), spp=1).save(os.path.join(self.folder.name, "map.exr"))
        return add_uvs("./map.exr")


class RefusedTest(FaultTest):
    def test_the_weld_of_a_mesh_is_an_attribute(self):
        scene = self.load(make_mesh("m", "custom double relief:weld = 0.01"))
        self.assertEqual([mesh.weld for mesh in scene.meshes.values()], [0.01])
        copy = os.path.join(self.folder.name, "copy.usda")
        relief.usd.save(scene, copy)
        self.assertEqual([mesh.weld for mesh in relief.usd.load(copy).meshes.values()], [0.01])
        self.check_refused("/m", "distance of 0 or more", make_mesh("m", "custom double relief:weld = -1"))

    def test_attributes_of_displacements_that_cannot_be_meant(self):
        uvs = self.write_map()
        for words, line in (("scale is .* three", "matrix4d relief:displacement:scale = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))"),
                            ("midlevel is .* three", "float[] relief:displacement:midlevel = [1, 2, 3, 4]"),
                            ("scale is nan", "float relief:displacement:scale = nan"),
                            ("scal is no key", "float relief:displacement:scal = 1")):
            self.check_refused("/m", words, make_mesh("m", *uvs, f"custom {line}"))
        scene = self.load(make_mesh("m", *uvs, "custom float relief:displacement:scale", "custom float relief:displacement:midlevel = 0.5"))
        self.check_reported("/m", "relief:displacement:scale has no value")
        self.assertEqual(list(scene.displacements.values())[0]["midlevel"], 0.5)

    def test_levels_and_sizes(self):
        for value in ('string relief:subdivision:level = "a"', "int relief:subdivision:level = 100", "float relief:subdivision:level = nan"):
            self.check_refused("/m", "relief:subdivision:level is", make_mesh("m", f"custom {value}", scheme="catmullClark"))
        self.check_refused("/s", "radius is nan", make_prim("Sphere", "s", "double radius = nan"))
        settings = make_prim("Scope", "Render", inner=make_prim("RenderSettings", "s", "int2 resolution = (0, -5)"))
        self.check_refused("/Render/s", "resolution is", make_mesh("m"), settings)

    def test_lights(self):
        for words, kind, line in (("intensity is inf", "SphereLight", "float inputs:intensity = inf"),
                                  ("intensity is -1", "SphereLight", "float inputs:intensity = -1"),
                                  ("intensity is -1", "DomeLight", "float inputs:intensity = -1"),
                                  ("exposure 1000", "SphereLight", "float inputs:exposure = 1000"),
                                  ("color is", "RectLight", "color3f inputs:color = (nan, 0, 0)"),
                                  ("radius is -1", "SphereLight", "float inputs:radius = -1"),
                                  ("angle is -1", "DistantLight", "float inputs:angle = -1")):
            self.check_refused("/l", words, make_mesh("m"), make_prim(kind, "l", line))
        for kind in ("RectLight", "DistantLight"):
            flat = ("double3 xformOp:scale = (0, 0, 0)", 'uniform token[] xformOpOrder = ["xformOp:scale"]')
            self.assertEqual(self.load(make_mesh("m"), make_prim(kind, "l", *flat)).lights, [])

    def test_cameras_and_their_shutters(self):
        self.check_refused("/c", "focalLength is nan", make_mesh("m"), make_prim("Camera", "c", "float focalLength = nan"))
        self.check_refused("/c", "shutter:open is -100", make_mesh("m"), make_prim("Camera", "c", "double shutter:open = -100"), frames="1-2")
        flat = ("double3 xformOp:scale = (0, 0, 0)", 'uniform token[] xformOpOrder = ["xformOp:scale"]')
        self.check_refused("/c", "has no extent", make_mesh("m"), make_prim("Camera", "c", *flat))

    def test_transforms_that_are_not_numbers_on_their_way(self):
        moved = ("double3 xformOp:translate.timeSamples = { 1: (1, 1, 1), 5: (nan, 0, 0) }",
                 'uniform token[] xformOpOrder = ["xformOp:translate"]')
        self.check_refused("/x/m", "not finite at frame", make_prim("Xform", "x", *moved, inner=make_mesh("m")), frames="1-5")

    def test_options(self):
        for words, options in (("time is 'a'", dict(time="a")), ("time is nan", dict(time=math.nan)), ("frames is 5", dict(frames=5)),
                               ("purposes has 'rendr'", dict(purposes=["rendr"])), ("camera is 5", dict(camera=5)),
                               ("subdivision_level is 'a'", dict(subdivision_level="a"))):
            self.check_refused("", words, make_mesh("m"), **options)
        self.check_refused("", "metersPerUnit is 0", '(\nmetersPerUnit = 0\n)\n', make_mesh("m"), meters=True)

    def test_all_else_that_goes_wrong_names_its_prim(self):
        wrong = make_prim("SphereLight", "l", 'custom token[] inputs:radius = ["a", "b"]')
        self.check_refused("/l", "cannot be read: ", make_mesh("m"), wrong)


class LeftOutTest(FaultTest):
    """One bad mesh does not end a stage."""

    def check_left_out(self, words, *prims, path="/bad", **options):
        with self.subTest(words=words, path=path):
            scene = self.load(*prims, make_mesh("good"), **options)
            self.assertEqual([entry["name"] for entry in scene.objects], ["/good"])
            self.check_reported(path, words)
            relief.render(scene, size=(8, 8), spp=1)
            with self.assertRaisesRegex(relief.Error, "no mesh that can be seen"):
                self.load(*prims, **options)
            self.check_reported(path, words)

    def test_meshes_without_an_area(self):
        for scheme in ("none", "catmullClark"):
            for points in ("[(1, 1, 1), (1, 1, 1), (1, 1, 1), (1, 1, 1)]", "[(0, 0, 0), (1, 1, 1), (2, 2, 2), (3, 3, 3)]"):
                mesh = make_mesh("bad", scheme=scheme)
                self.check_left_out("no area", mesh.replace("[(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]", points))
        self.check_left_out("no area", make_prim("Cube", "bad", "double size = 0"))

    def test_parts_without_an_area(self):
        points = SQUARE.replace("(-1, 1, 0)]", "(-1, 1, 0), (5, 5, 5)]").replace("[4]", "[4, 3]").replace("2, 3]", "2, 3, 4, 4, 4]")
        subset = make_prim("GeomSubset", "flat", 'uniform token elementType = "face"', 'uniform token familyName = "materialBind"',
                           "int[] indices = [1]")
        scene = self.load(make_prim("Mesh", "m", points, 'uniform token subdivisionScheme = "none"', inner=subset))
        self.assertEqual([entry["name"] for entry in scene.objects], ["/m"])
        self.check_reported("/m/flat", "no area")

    def test_points_that_are_nowhere(self):
        for value in ("nan", "inf", "1e20"):
            for scheme in ("none", "catmullClark"):
                self.check_left_out("point 1 is not finite", make_mesh("bad", scheme=scheme).replace("(1, -1, 0)", f"({value}, -1, 0)"))

    def test_points_that_are_nowhere_later(self):
        moving = SQUARE.replace("points = [", "points.timeSamples = { 1: [").replace("(-1, 1, 0)]", "(-1, 1, 0)], 3: [(nan, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)] }")
        self.check_refused("/m", "is no mesh at frame", make_prim("Mesh", "m", moving), frames="1-3",
                           folder=self.folder.name)

    def test_creases_along_no_edge(self):
        points = "point3f[] points = [(-1,-1,0), (0,-1,0), (1,-1,0), (1,1,0), (0,1,0), (-1,1,0)]"
        faces = ("int[] faceVertexCounts = [4, 4]", "int[] faceVertexIndices = [0, 1, 4, 5, 1, 2, 3, 4]")
        sharp = "int[] creaseLengths = [2, 2]", "float[] creaseSharpnesses = [2, 3]"
        for dropped, creases in (("int[] holeIndices = [1]", "int[] creaseIndices = [2, 3, 0, 1]"), ("", "int[] creaseIndices = [0, 4, 0, 1]")):
            with self.subTest(creases):
                scene = self.load(make_prim("Mesh", "m", points, *faces, dropped, creases, *sharp))
                self.check_reported("/m", "1 of its creases are along no edge")
                mesh = scene.meshes["m"]
                self.assertEqual((mesh.creases.tolist(), mesh.sharpness.tolist()), ([[0, 1]], [3]))
                relief.render(scene, size=(8, 8), spp=1)
        for line in ("int[] creaseLengths = [6, -2]", "int[] creaseLengths = [5, -1]"):
            self.load(make_prim("Mesh", "m", points, *faces, "int[] creaseIndices = [0, 1, 2, 3]", line, "float[] creaseSharpnesses = [1, 1]"))
            self.check_reported("/m", "creases do not fit together")
        self.load(make_prim("Mesh", "m", points, *faces, "int[] creaseIndices = [0, 1]", "int[] creaseLengths = [2]",
                            "float[] creaseSharpnesses = [nan]"))
        self.check_reported("/m", "creases do not fit together")


class MaterialTest(FaultTest):
    def test_values_of_materialx_that_do_not_fit_are_reported(self):
        bound = 'def Mesh "m" (\nprepend apiSchemas = ["MaterialBindingAPI"]\n) {\nrel material:binding = </Mtl/Materials/mm>' + SQUARE + "}\n"
        for value, kind in (("1,0", "color3"), ("a", "float"), ("1,2", "float"), ("1.5", "integer")):
            with open(os.path.join(self.folder.name, "look.mtlx"), "w", encoding="utf-8") as file:
                file.write(f'<?xml version="1.0"?>\n<materialx version="1.38"><standard_surface name="ss" type="surfaceshader">'
                           f'<input name="base_color" type="{kind}" value="{value}"/></standard_surface><surfacematerial name="mm" '
                           f'type="material"><input name="surfaceshader" type="surfaceshader" nodename="ss"/></surfacematerial></materialx>')
            self.load(bound, 'def Scope "Mtl" (references = @./look.mtlx@</MaterialX>) {}')
            self.check_reported("/Mtl", f"look.mtlx: input base_color of type {kind} has the value '{value}'")

    def test_numbers_of_materials_are_finite(self):
        bound = 'def Mesh "m" (\nprepend apiSchemas = ["MaterialBindingAPI"]\n) {\nrel material:binding = </M>' + SQUARE + "}\n"
        shader = make_prim("Shader", "s", 'uniform token info:id = "UsdPreviewSurface"', "float inputs:roughness = nan", "token outputs:surface")
        material = make_prim("Material", "M", "token outputs:surface.connect = </M/s.outputs:surface>", inner=shader)
        self.check_refused("/M/s", "roughness is nan", bound, material)
        self.load(make_mesh("m", "color3f[] primvars:displayColor = [(nan, 0, 0)]"))
        self.check_reported("/m", "displayColor is not finite")


if __name__ == "__main__":
    unittest.main()
