"""relief.usd: cameras, lights and materials."""
import math
import os
import pathlib
import unittest
import zipfile

import numpy as np

import usd_stages as stages
from test_usd import UsdTest

try:
    from pxr import Gf, Sdf, UsdGeom, UsdLux, UsdRender, UsdShade, UsdUtils
except ImportError:
    pass


class Cameras(UsdTest):
    def test_angle_place_and_depth_of_field(self):
        stage = stages.create(self.path)
        stages.add_square(stage, "/m")
        camera = UsdGeom.Camera.Define(stage, "/camera")
        camera.AddTranslateOp().Set(Gf.Vec3d(1, 2, 3))
        camera.AddRotateYOp().Set(90)
        camera.CreateFocalLengthAttr(50)
        camera.CreateVerticalApertureAttr(24)
        camera.CreateHorizontalApertureAttr(36)
        camera.CreateFStopAttr(2)
        camera.CreateFocusDistanceAttr(10)
        scene = self.load(stage)
        found = scene.camera
        np.testing.assert_allclose(found["from"], [1, 2, 3])
        np.testing.assert_allclose(found["to"], [-9, 2, 3], atol=1e-12)  # turned from -z to -x
        np.testing.assert_allclose(found["up"], [0, 1, 0], atol=1e-12)
        self.assertAlmostEqual(found["fov_degrees"], math.degrees(2 * math.atan(12 / 50)), 5)
        self.assertAlmostEqual(found["aperture_radius"], 5 / 2 / 2)  # 50 tenths of a unit, a half of which is open
        self.assertEqual((found["focus_distance"], scene.render["width"], scene.render["height"]), (10, 1280, 853))

    def test_aperture_offsets_are_lens_shifts(self):
        stage = stages.create(self.path)
        stages.add_square(stage, "/m")
        camera = UsdGeom.Camera.Define(stage, "/camera")
        camera.CreateVerticalApertureAttr(24)
        self.assertNotIn("shift", self.load(stage).camera)
        camera.CreateHorizontalApertureOffsetAttr(6)
        camera.CreateVerticalApertureOffsetAttr(-12)
        self.assertEqual(self.load(stage).camera["shift"], [0.25, -0.5])

    def test_the_camera_is_that_of_the_settings_or_that_asked_for(self):
        stage = stages.create(self.path)
        stages.add_square(stage, "/m")
        for name, x in (("a", 1), ("b", 2)):
            UsdGeom.Camera.Define(stage, f"/{name}").AddTranslateOp().Set(Gf.Vec3d(x, 0, 0))
        self.assertEqual(self.load(stage).camera["from"][0], 1)
        settings = UsdRender.Settings.Define(stage, "/Render/settings")
        settings.CreateCameraRel().SetTargets(["/b"])
        settings.CreateResolutionAttr(Gf.Vec2i(320, 200))
        scene = self.load(stage)
        self.assertEqual((scene.camera["from"][0], scene.render["width"], scene.render["height"]), (2, 320, 200))
        self.assertTrue(self.reported("/a", "is not the camera"))
        self.assertEqual(self.load(camera="/a").camera["from"][0], 1)


class Lights(UsdTest):
    def load_light(self, kind, api=None, **values):
        """One light that is scaled by two and stands at (0, 5, 0), and its numbers."""
        stage = stages.create(self.path)
        stages.add_square(stage, "/m")
        light = getattr(UsdLux, kind).Define(stage, "/light")
        light.AddTranslateOp().Set(Gf.Vec3d(0, 5, 0))
        light.AddRotateXOp().Set(-90)
        light.AddScaleOp().Set(Gf.Vec3f(2, 2, 2))
        if api:
            api.Apply(light.GetPrim())
        for name, value in values.items():
            light.GetPrim().GetAttribute(name if name == "treatAsPoint" else f"inputs:{name}").Set(value)
        scene = self.load(stage)
        self.folder.cleanup()
        os.makedirs(self.folder.name)
        return scene.lights[0] if scene.lights else scene.environment

    def test_radiance_becomes_radiant_intensity(self):
        # intensity 3 with two stops more is the radiance 12; areas are those in the world.
        radiance = {"intensity": 3.0, "exposure": 2.0}
        rectangle = self.load_light("RectLight", width=2.0, height=0.5, **radiance)
        self.assertAlmostEqual(rectangle["strength"], 12 * 4 * 1)
        self.assertEqual((rectangle["type"], rectangle["width"], rectangle["height"]), ("rectangle", 4, 1))
        np.testing.assert_allclose(rectangle["direction"], [0, -1, 0], atol=1e-12)
        np.testing.assert_allclose(rectangle["position"], [0, 5, 0])
        self.assertAlmostEqual(self.load_light("DiskLight", radius=0.5, **radiance)["strength"], 12 * math.pi)
        sphere = self.load_light("SphereLight", radius=0.25, **radiance)
        self.assertAlmostEqual(sphere["strength"], 12 * math.pi / 4)
        self.assertEqual((sphere["type"], sphere["radius"]), ("point", 0.5))

    def test_normalized_lights_do_not_depend_on_their_size(self):
        for kind, expected in (("RectLight", 6.0), ("DiskLight", 6.0), ("SphereLight", 1.5)):
            # Of a sphere a quarter of the surface is the disc that is seen.
            self.assertAlmostEqual(self.load_light(kind, intensity=6.0, normalize=True)["strength"], expected)
        point = self.load_light("SphereLight", intensity=6.0, normalize=True, treatAsPoint=True)
        self.assertEqual((point["radius"], point["strength"]), (0, 1.5))

    def test_suns_have_irradiance(self):
        sun = self.load_light("DistantLight", intensity=100.0, angle=10.0)
        self.assertAlmostEqual(sun["strength"], 100 * math.pi * math.sin(math.radians(5)) ** 2)
        self.assertEqual(sun["angle_degrees"], 10)
        np.testing.assert_allclose(np.array(sun["direction"]) / 2, [0, -1, 0], atol=1e-12)
        self.assertEqual(self.load_light("DistantLight", intensity=3.0, angle=10.0, normalize=True)["strength"], 3)
        self.assertEqual(self.load_light("DistantLight", intensity=3.0, angle=0.0)["strength"], 3)

    def test_colours_and_temperatures(self):
        self.assertEqual(self.load_light("SphereLight", color=Gf.Vec3f(1, 0.5, 0.25))["color"], [1, 0.5, 0.25])
        warm = self.load_light("SphereLight", enableColorTemperature=True, colorTemperature=3000.0)["color"]
        np.testing.assert_allclose(warm, UsdLux.BlackbodyTemperatureAsRgb(3000))
        self.assertGreater(warm[0], 2 * warm[2])

    def test_cones_are_spots(self):
        spot = self.load_light("SphereLight", UsdLux.ShapingAPI, radius=0.25, intensity=2.0,
                               **{"shaping:cone:angle": 30.0, "shaping:cone:softness": 0.25})
        self.assertEqual((spot["type"], spot["angle_degrees"], spot["blend"]), ("spot", 60, 0.25))
        self.assertAlmostEqual(spot["strength"], 2 * math.pi / 4)
        np.testing.assert_allclose(spot["direction"], [0, -1, 0], atol=1e-12)

    def test_domes_are_environments_turned_by_half(self):
        stage = stages.create(self.path)
        stages.add_square(stage, "/m")
        stages.write_png(os.path.join(self.folder.name, "sky.png"), stages.make_picture())
        dome = UsdLux.DomeLight.Define(stage, "/sky")
        dome.CreateTextureFileAttr("./sky.png")
        dome.CreateIntensityAttr(2)
        dome.CreateExposureAttr(1)
        dome.AddRotateYOp().Set(30)
        found = self.load(stage).environment
        self.assertEqual((found["strength"], os.path.basename(found["file"])), (4, "sky.png"))
        self.assertAlmostEqual(found["rotate_degrees"], 210, 5)
        dome.GetPrim().SetTypeName("DomeLight_1")
        UsdGeom.SetStageUpAxis(stage, "Z")
        dome.ClearXformOpOrder()
        dome.AddRotateZOp().Set(30)
        self.assertAlmostEqual(self.load(stage).environment["rotate_degrees"], 210, 5)
        self.assertFalse(self.reported("/sky", "pole"))

    def test_a_dome_of_rgbe_is_read_and_one_that_is_cut_is_named_and_left_out(self):
        stage = stages.create(self.path)
        stages.bind(stages.add_square(stage, "/m"), stages.add_material(stage, "/look"))
        file = os.path.join(self.folder.name, "sky.hdr")
        header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n"
        with open(file, "wb") as sky:
            sky.write(header + bytes((128, 128, 128, 129)) * 4)
        dome = UsdLux.DomeLight.Define(stage, "/sky")
        dome.CreateTextureFileAttr("./sky.hdr")
        dome.CreateIntensityAttr(2)
        found = self.load(stage)
        self.assertEqual(os.path.basename(found.environment["file"]), "sky.hdr")
        self.assertFalse(any("sky.hdr" in line for line in self.report))
        found.validate()
        with open(file, "wb") as sky:
            sky.write(header + bytes((128, 128, 128, 129)) * 3)
        found = self.load()
        self.assertNotIn("file", found.environment)
        self.assertEqual(found.environment["strength"], 2)
        self.assertTrue(self.reported("environment", "sky.hdr cannot be read and is left out"))
        found.validate()

    def test_a_displacement_whose_map_is_no_picture_is_named_and_left_out(self):
        stage = stages.create(self.path)
        mesh = stages.add_mesh(stage, "/m", [(0, 0, 0), (1, 0, 0), (1, 0, -1), (0, 0, -1)], [4], [0, 1, 2, 3], uvs=[(0, 0), (1, 0), (1, 1), (0, 1)])
        with open(os.path.join(self.folder.name, "map.png"), "wb") as picture:
            picture.write(b"no picture")
        mesh.GetPrim().CreateAttribute("relief:displacement:file", Sdf.ValueTypeNames.Asset).Set("./map.png")
        found = self.load(stage)
        self.assertEqual(found.displacements, {})
        self.assertNotIn("displacement", found.objects[0])
        self.assertTrue(any("map.png cannot be read and is left out" in line for line in self.report), self.report)
        found.validate()

    def test_what_is_there_in_another_form_is_a_note(self):
        stage = stages.create(self.path)
        UsdGeom.Sphere.Define(stage, "/ball")
        self.load(stage)
        self.assertTrue(any(line.startswith("note: /ball: Sphere is a mesh of") for line in self.report), self.report)

    def test_links_become_names(self):
        stage = stages.create(self.path)
        for name in ("a", "b", "c"):
            stages.add_square(stage, f"/set/{name}")
        light = UsdLux.SphereLight.Define(stage, "/light")
        links = UsdLux.LightAPI(light).GetLightLinkCollectionAPI()
        links.CreateExcludesRel().SetTargets(["/set/b"])
        self.assertEqual(self.load(stage).lights[0]["light_link_excludes"], ["/set/b"])
        links.CreateExcludesRel().SetTargets([])
        links.CreateIncludeRootAttr(False)
        links.CreateIncludesRel().SetTargets(["/set/c"])
        self.assertEqual(self.load(stage).lights[0]["light_link_includes"], ["/set/c"])


class Materials(UsdTest):
    def make(self, identifier="UsdPreviewSurface", context="", texture=None, **inputs):
        """A square of one material; `texture` makes the texture, and inputs of "r" and so on are its outputs."""
        stage = stages.create(self.path)
        mesh = stages.add_square(stage, "/m")
        stages.write_png(os.path.join(self.folder.name, "maps/a.png"), stages.make_picture())
        if texture is not None:
            shader = stages.add_texture(stage, "/look/texture", "./maps/a.png", **texture)
            inputs = {name: (shader, value) if value in ("r", "g", "b", "a", "rgb", "out") else value for name, value in inputs.items()}
        material = stages.add_material(stage, "/look", identifier, context, **inputs)
        stages.bind(mesh, material)
        return stage

    def load_look(self, *arguments, **inputs):
        scene = self.load(self.make(*arguments, **inputs))
        self.assertEqual(scene.objects[0]["material"], "look")
        return scene.materials["look"]

    def test_numbers_of_a_preview_surface(self):
        look = self.load_look(diffuseColor=(0.5, 0.25, 0.125), metallic=1.0, roughness=0.25, ior=1.25, clearcoat=0.5,
                              clearcoatRoughness=0.75, emissiveColor=(2.0, 1.0, 0.0))
        self.assertEqual(look, {"base_color": [0.5, 0.25, 0.125], "base_metalness": 1, "specular_roughness": 0.25,
                                "specular_ior": 1.25, "coat_weight": 0.5, "coat_roughness": 0.75, "coat_ior": 1.25,
                                "coat_darkening": 0, "emission": [2, 1, 0]})

    def test_an_opacity_threshold_makes_all_or_nothing(self):
        self.assertEqual(self.load_look(opacity=0.25)["geometry_opacity"], 0.25)
        os.remove(self.path)
        self.assertEqual(self.load_look(opacity=0.25, opacityThreshold=0.5)["geometry_opacity"], 0)
        os.remove(self.path)
        self.assertNotIn("geometry_opacity", self.load_look(opacity=0.75, opacityThreshold=0.5))

    def test_the_specular_workflow_keeps_the_reflection_at_normal_incidence(self):
        look = self.load_look(useSpecularWorkflow=1, specularColor=(0.09, 0.045, 0.09))
        self.assertAlmostEqual(((look["specular_ior"] - 1) / (look["specular_ior"] + 1)) ** 2, 0.09, 6)
        np.testing.assert_allclose(look["specular_color"], [1, 0.5, 1], rtol=1e-6)

    def test_textures_with_channel_scale_wrap_and_color_space(self):
        look = self.load_look(texture={"wrapS": "mirror", "wrapT": "mirror", "sourceColorSpace": "sRGB", "scale": (0.5, 0.25, 1.0, 1.0)},
                              diffuseColor="rgb", roughness="g")
        self.assertEqual(os.path.basename(look["base_color"].pop("file")), "a.png")
        self.assertEqual(look["base_color"], {"wrap": "mirror", "factor": [0.5, 0.25, 1], "color_space": "srgb"})
        look["specular_roughness"].pop("file")
        self.assertEqual(look["specular_roughness"], {"wrap": "mirror", "factor": 0.25, "channel": "g", "color_space": "srgb"})

    def test_alpha_of_a_picture_without_alpha_is_one(self):
        self.assertNotIn("file", str(self.load_look(texture={}, opacity="a").get("geometry_opacity")))

    def test_transforms_of_uvs_and_their_names(self):
        stage = self.make(texture={}, diffuseColor="rgb")
        reader = UsdShade.Shader.Define(stage, "/look/reader")
        reader.CreateIdAttr("UsdPrimvarReader_float2")
        stages.set_input(reader, "varname", "second")
        move = UsdShade.Shader.Define(stage, "/look/move")
        move.CreateIdAttr("UsdTransform2d")
        stages.set_input(move, "in", (reader, "result"))
        stages.set_input(move, "scale", (2.0, 4.0))
        stages.set_input(move, "translation", (0.25, 0.5))
        stages.set_input(UsdShade.Shader(stage.GetPrimAtPath("/look/texture")), "st", (move, "result"))
        stages.add_uvs(UsdGeom.Mesh(stage.GetPrimAtPath("/m")), [(0.5, 0.5)] * 4, "vertex", name="second")
        scene = self.load(stage)
        look = scene.materials["look"]["base_color"]
        self.assertEqual((look["uv_scale"], look["uv_offset"]), ([2, 4], [0.25, 0.5]))
        self.assertTrue((scene.meshes["m"].uvs == 0.5).all())

    def test_normal_maps_of_opengl_and_directx(self):
        for sign in (1.0, -1.0):
            look = self.load_look(texture={"scale": (2.0, 2 * sign, 2.0, 1.0), "bias": (-1.0, -sign, -1.0, 0.0)}, normal="rgb")
            self.assertEqual(look["geometry_normal"].get("flip_y", False), sign < 0)
            os.remove(self.path)

    def test_displacement_of_a_preview_surface_is_a_height_map(self):
        scene = self.load(self.make(texture={"scale": (0.5,) * 4, "bias": (-0.125,) * 4}, displacement="r"))
        found = scene.displacements[scene.objects[0]["displacement"]]
        self.assertEqual({k: found[k] for k in ("type", "scale", "midlevel", "encoding")},
                         {"type": "height", "scale": 0.5, "midlevel": 0.25, "encoding": "float"})

    def test_vector_displacement_of_materialx(self):
        stage = self.make("ND_open_pbr_surface_surfaceshader", "mtlx", base_color=(0.5, 0.5, 0.5))
        shader = UsdShade.Shader.Define(stage, "/look/displacement")
        shader.CreateIdAttr("ND_displacement_vector3")
        image = stages.add_texture(stage, "/look/vectors", "./maps/a.png", "ND_image_vector3")
        subtract = UsdShade.Shader.Define(stage, "/look/subtract")
        subtract.CreateIdAttr("ND_subtract_vector3")
        stages.set_input(subtract, "in1", (image, "out"))
        stages.set_input(subtract, "in2", (0.5, 0.5, 0.5))
        stages.set_input(shader, "displacement", (subtract, "out"))
        stages.set_input(shader, "scale", 0.25)
        UsdShade.Material(stage.GetPrimAtPath("/look")).CreateDisplacementOutput("mtlx").ConnectToSource(
            shader.CreateOutput("out", Sdf.ValueTypeNames.Token))
        found = self.load(stage).displacements["look"]
        self.assertEqual({k: found[k] for k in ("type", "space", "axes", "lengths", "frame", "scale", "midlevel")},
                         {"type": "vector", "space": "tangent", "axes": "t,b,n", "lengths": "relative", "frame": "dpdu",
                          "scale": 0.25, "midlevel": 0.5})
        found = self.load(vector_space="object").displacements["look"]
        self.assertEqual((found["space"], found["axes"]), ("object", "x,y,z"))

    def test_attributes_say_what_a_displacement_map_means(self):
        stage = self.make()
        mesh = stage.GetPrimAtPath("/m")
        for name, kind, value in (("file", "Asset", "./maps/a.png"), ("preset", "Token", "mudbox"), ("scale", "Float3", (1, 2, 3)),
                                  ("flip_v", "Bool", True), ("filter", "String", "cubic")):
            mesh.CreateAttribute(f"relief:displacement:{name}", getattr(Sdf.ValueTypeNames, kind)).Set(value)
        scene = self.load(stage)
        found = dict(scene.displacements[scene.objects[0]["displacement"]])
        self.assertEqual(os.path.basename(found.pop("file")), "a.png")
        self.assertEqual(found, {"preset": "mudbox", "scale": [1, 2, 3], "flip_v": True, "filter": "cubic"})

    def test_open_pbr_keeps_its_names(self):
        look = self.load_look("ND_open_pbr_surface_surfaceshader", "mtlx", base_color=(0.5, 0.25, 1.0), fuzz_weight=0.5,
                              fuzz_color=(0.25, 0.5, 1.0), specular_roughness=0.125, coat_weight=0.75, emission_luminance=4.0,
                              emission_color=(0.5, 0.25, 0.0), subsurface_weight=0.5, specular_roughness_anisotropy=0.75)
        self.assertEqual(look, {"base_color": [0.5, 0.25, 1], "fuzz_weight": 0.5, "fuzz_color": [0.25, 0.5, 1], "fuzz_roughness": 0.5,
                                "specular_roughness": 0.125, "specular_roughness_anisotropy": 0.75, "coat_weight": 0.75,
                                "coat_roughness": 0, "emission": [2, 1, 0]})
        self.assertTrue(self.reported("/look", "subsurface_weight is not taken over"))

    def test_the_standard_surface_by_its_other_names(self):
        look = self.load_look("ND_standard_surface_surfaceshader", "mtlx", base=0.5, specular=0.75, coat=1.0,
                              sheen=0.125, thin_walled=True, specular_IOR=1.25, coat_IOR=2.0)
        self.assertEqual({k: look[k] for k in ("base_weight", "specular_weight", "coat_weight", "fuzz_weight",
                                               "geometry_thin_walled", "specular_ior", "coat_ior", "specular_roughness")},
                         {"base_weight": 0.5, "specular_weight": 0.75, "coat_weight": 1, "fuzz_weight": 0.125,
                          "geometry_thin_walled": True, "specular_ior": 1.25, "coat_ior": 2, "specular_roughness": 0.2})

    def test_specular_of_a_standard_metal_is_not_its_weight(self):
        look = self.load_look("ND_standard_surface_surfaceshader", "mtlx", metalness=1.0, specular=0.0)
        self.assertEqual((look["base_metalness"], look.get("specular_weight", 1)), (1, 1))

    def test_materialx_files_are_read(self):
        stages.write_png(os.path.join(self.folder.name, "looks/tex/a.png"), stages.make_picture())
        pathlib.Path(self.folder.name, "looks/gold.mtlx").write_text("""<?xml version="1.0"?>
            <materialx version="1.38" colorspace="lin_rec709" fileprefix="tex/">
              <nodegraph name="graph">
                <input name="tint" type="color3" value="0.5, 0.25, 1"/>
                <image name="image" type="color3"><input name="file" type="filename" value="a.png" colorspace="srgb_texture"/></image>
                <multiply name="product" type="color3">
                  <input name="in1" type="color3" nodename="image"/><input name="in2" type="color3" interfacename="tint"/>
                </multiply>
                <output name="out" type="color3" nodename="product"/>
              </nodegraph>
              <open_pbr_surface name="shader" type="surfaceshader">
                <input name="base_color" type="color3" nodegraph="graph" output="out"/>
                <input name="base_metalness" type="float" value="1"/>
              </open_pbr_surface>
              <surfacematerial name="gold" type="material">
                <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
              </surfacematerial>
            </materialx>""")
        stage = stages.create(self.path)
        mesh = stages.add_square(stage, "/m")
        warnings = UsdUtils.CoalescingDiagnosticDelegate()  # usd-core cannot open what is added here
        stage.DefinePrim("/looks", "Scope").GetReferences().AddReference("./looks/gold.mtlx", "/MaterialX/Materials")
        self.assertTrue(warnings.TakeUncoalescedDiagnostics())
        UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim())
        mesh.GetPrim().CreateRelationship("material:binding").SetTargets(["/looks/gold"])
        look = self.load(stage).materials["gold"]
        self.assertTrue(look["base_color"].pop("file").endswith("looks/tex/a.png"))
        self.assertEqual(look, {"base_color": {"factor": [0.5, 0.25, 1], "color_space": "srgb"}, "base_metalness": 1,
                                "specular_roughness": look["specular_roughness"]})
        self.assertFalse(self.reported("/looks", "cannot be opened"))

    def test_subdivided_faces_that_are_no_sheet_are_refined_here(self):
        stage = stages.create(self.path)
        points = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 0), (-1, 1, 0), (0, 0, 1), (0, 1, 1)]
        stages.add_mesh(stage, "/m", points, [4, 4, 4], [0, 2, 3, 1, 1, 5, 4, 0, 0, 1, 7, 6], "catmullClark")
        scene = self.load(stage, subdivision_level=2)
        self.assertEqual((len(scene.meshes["m"].sizes), scene.meshes["m"].subdivision), (3 * 16, None))
        self.assertTrue(self.reported("/m", "no closed sheet"))
        self.assertEqual(scene.validate(), [])

    def test_subsets_become_objects_that_meet(self):
        stage = stages.create(self.path)
        mesh = stages.add_mesh(stage, "/m", [(0, 0, 0), (1, 0, 0), (1, 0, -1), (0, 0, -1), (2, 1, 0), (2, 1, -1)], [4, 4],
                               [0, 1, 2, 3, 1, 4, 5, 2], uvs=[(k, k) for k in range(8)])
        stages.write_png(os.path.join(self.folder.name, "maps/a.png"), stages.make_picture())
        attribute = mesh.GetPrim().CreateAttribute("relief:displacement:file", Sdf.ValueTypeNames.Asset)
        attribute.Set("./maps/a.png")
        for k, name in enumerate(("red", "blue")):
            subset = UsdShade.MaterialBindingAPI(mesh).CreateMaterialBindSubset(name, [k])
            stages.bind(subset, stages.add_material(stage, f"/{name}_look", diffuseColor=(0.5, float(k), 0.5)))
        scene = self.load(stage)
        self.assertEqual([(o["name"], o["material"]) for o in scene.objects], [("/m/red", "red_look"), ("/m/blue", "blue_look")])
        self.assertTrue(self.reported("/m", "is split into 2 objects"))
        found = []
        for entry in scene.objects:
            mesh = scene.meshes[entry["mesh"]]
            normals = mesh.normals[mesh.normal_indices]
            found.append({tuple(p): n for p, n in zip(mesh.positions[mesh.corners].tolist(), normals.tolist())})
            self.assertEqual(scene.displacements[entry["displacement"]]["frame"], "file")
        shared = found[0].keys() & found[1].keys()
        self.assertEqual(len(shared), 2)
        for place in shared:  # the mean of a flat face and one that rises by 45 degrees
            self.assertEqual(found[0][place], found[1][place])
            np.testing.assert_allclose(found[0][place], [-math.sin(math.pi / 8), math.cos(math.pi / 8), 0], atol=1e-6)

    def test_subsets_of_a_subdivided_mesh_lie_on_its_limit(self):
        stage = stages.create(self.path)
        points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        faces = [0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3]
        mesh = stages.add_mesh(stage, "/m", points, [4] * 6, faces, "catmullClark")
        subset = UsdShade.MaterialBindingAPI(mesh).CreateMaterialBindSubset("top", [3])
        stages.bind(subset, stages.add_material(stage, "/look"))
        scene = self.load(stage, subdivision_level=3)
        top, rest = (scene.meshes[entry["mesh"]] for entry in scene.objects)
        self.assertEqual((len(top.sizes), len(rest.sizes), top.subdivision), (64, 5 * 64, None))
        shared = {tuple(p) for p in top.positions.tolist()} & {tuple(p) for p in rest.positions.tolist()}
        self.assertEqual(len(shared), 4 * 8)
        # Limit of a corner of three faces: (9 P + 4 (sum of edges) + (sum of opposites)) / 24; of the middle of a face.
        self.assertIn((-0.5, 0.5, -0.5), shared)
        self.assertAlmostEqual(float(top.positions[:, 1].max()), 68 / 81, 6)
        normals = top.normals[top.normal_indices][np.argmax(top.positions[top.corners][:, 1])]
        np.testing.assert_allclose(normals, [0, 1, 0], atol=1e-6)

    def test_tiles_and_packages(self):
        stage = self.make(texture={}, diffuseColor="rgb")
        for tile in (1001, 1002):
            stages.write_png(os.path.join(self.folder.name, f"maps/b.{tile}.png"), stages.make_picture(tile))
        shader = UsdShade.Shader(stage.GetPrimAtPath("/look/texture"))
        shader.GetInput("file").Set(Sdf.AssetPath("./maps/b.<UDIM>.png"))
        self.assertTrue(self.load(stage).materials["look"]["base_color"]["file"].endswith("maps/b.<UDIM>.png"))
        shader.GetInput("file").Set(Sdf.AssetPath("./maps/a.png"))
        stage.GetRootLayer().Save()
        package = os.path.join(self.folder.name, "shot.usdz")
        self.assertTrue(UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(self.path), package))
        self.path = package
        with zipfile.ZipFile(package) as archive:
            inside = next(archive.read(name) for name in archive.namelist() if name.endswith("a.png"))
        out = os.path.join(self.folder.name, "unpacked")
        file = self.load(folder=out).materials["look"]["base_color"]["file"]
        self.assertEqual(os.path.dirname(file), out)
        with open(file, "rb") as unpacked:
            self.assertEqual(unpacked.read(), inside)

    def test_a_missing_texture_is_reported(self):
        stage = self.make(texture={}, diffuseColor="rgb")
        UsdShade.Shader(stage.GetPrimAtPath("/look/texture")).GetInput("file").Set(Sdf.AssetPath("./none.png"))
        self.assertEqual(self.load(stage).materials["look"]["base_color"], [0.18] * 3)
        self.assertTrue(self.reported("/look", "there is no texture ./none.png"))


if __name__ == "__main__":
    unittest.main()
