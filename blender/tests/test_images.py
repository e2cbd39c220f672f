"""Images: those that cannot be read, tiles, and what reading leaves in the file that is open."""
from support import BlenderTest, displace, main, make_grid, make_hook, make_image, make_material  # first: finds the add-on
from unittest import mock

import bpy
import numpy as np
from relief_blender import images
from relief_blender.report import Report
from relief_blender.scene_export import SceneExport

import relief


class Images(BlenderTest):
    def make_missing(self):
        image = bpy.data.images.new("gone", 4, 4)
        image.source, image.filepath = "FILE", "/nowhere/gone.png"
        return image

    def make_glow(self):
        """The image texture of a pane that fills the picture and emits its colour."""
        bpy.context.scene.camera.rotation_euler, bpy.context.scene.camera.location = (0, 0, 0), (0, 0, 2)
        pane = make_grid(1)
        pane.scale = (5, 5, 1)
        material = make_material(pane)
        tree = material.node_tree
        emission, texture = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeTexImage")
        tree.links.new(emission.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
        tree.links.new(texture.outputs["Color"], emission.inputs["Color"])
        return texture, emission, tree

    def compare_colors(self, wanted):
        for engine in ("RELIEF", "CYCLES"):
            color = self.render(engine, samples=1)["Combined"][..., :3].mean((0, 1))
            np.testing.assert_allclose(color, wanted, atol=0.01, err_msg=engine)

    def test_a_missing_color_is_pink_as_in_cycles_and_named(self):
        texture, emission, tree = self.make_glow()
        self.compare_colors([1, 0, 1])
        self.assertIn('material "material": image texture "Image Texture" has no image: it is pink', self.report()[0])
        texture.image = self.make_missing()
        self.compare_colors([1, 0, 1])
        self.assertEqual(self.report(), ['material "material": image "gone" has no pixels: /nowhere/gone.png: '
                                         'it is pink, as in Cycles (File > External Data > Find Missing Files)'])
        tree.links.new(texture.outputs["Alpha"], emission.inputs["Color"])
        self.compare_colors([1, 1, 1])

    def test_signs_of_numbers_in_names_of_files_are_taken_as_they_are(self):
        texture, emission, _ = self.make_glow()
        for name in ("map##.exr", "a####b/map.exr", "map<UDIM>.exr", "map<uvtile>.exr"):
            file = self.folder / name
            file.parent.mkdir(exist_ok=True)
            image = make_image("made", np.full((4, 4, 3), (0.25, 0.5, 0.125)))
            image.filepath_raw, image.file_format = str(file), "OPEN_EXR"
            image.save()
            texture.image = bpy.data.images.load(str(file))
            texture.image.colorspace_settings.name, texture.image.source = "Non-Color", "FILE"
            with self.subTest(name=name):
                self.compare_colors([0.25, 0.5, 0.125])
                self.assertEqual(self.report(), [])

    def test_a_missing_environment_is_pink_as_in_cycles_and_named(self):
        tree = bpy.context.scene.world.node_tree
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        background = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBackground")
        tree.links.new(texture.outputs[0], background.inputs["Color"])
        bpy.context.scene.render.film_transparent = False
        self.compare_colors([1, 0, 1])
        for texture.projection in ("EQUIRECTANGULAR", "MIRROR_BALL"):
            texture.image = self.make_missing()
            self.compare_colors([1, 0, 1])
            self.assertIn("has no pixels: /nowhere/gone.png: it is pink", self.report()[0])

    def test_a_missing_displacement_displaces_nothing_and_is_named(self):
        ob = make_grid(4)
        flat = self.render("RELIEF", samples=4)
        material = make_material(ob)
        for kind in ("TANGENT", "HEIGHT"):
            texture = displace(material, make_image("hook", make_hook()), kind)
            self.assertGreater(np.mean(self.render("RELIEF", samples=4).mask != flat.mask), 0.001)
            texture.image = self.make_missing()
            self.assertEqual(np.mean(self.render("RELIEF", samples=4).mask != flat.mask), 0)
            self.assertIn('material "material": displacement: image "gone', self.report()[0])
            self.assertIn("nothing is displaced by it", self.report()[0])

    def save(self, texels, name="map.exr", colors="Non-Color"):
        image = make_image("made", texels)
        image.filepath_raw, image.file_format = str(self.folder / name), "OPEN_EXR"
        image.save()
        loaded = bpy.data.images.load(image.filepath_raw)
        loaded.colorspace_settings.name = colors
        loaded.name = "loaded"
        return loaded

    def test_texels_that_are_not_finite_leave_their_picture_out_and_it_is_named(self):
        ob = make_grid(2)
        material = make_material(ob)
        plain = self.render("RELIEF", "plain", samples=2)
        texels = make_hook(64)
        texels[5, 7, 1] = np.nan
        for is_file in (True, False):
            texture = displace(material, self.save(texels) if is_file else make_image("loaded", texels))
            texture.image.name = "loaded"
            ours = self.render("RELIEF", "bad", samples=2)
            self.assertEqual(np.mean(ours.mask != plain.mask), 0)
            self.assertEqual(len(self.report()), 1, self.report())
            line = self.report()[0]
            for part in ('material "material": displacement: image "loaded" cannot be used: 1 of its texels',
                         "NaN at column 7, row 5 from the top", "nothing is displaced by it"):
                self.assertIn(part, line)
            bpy.data.images.remove(texture.image)

    def test_a_truncated_file_is_left_out_and_named(self):
        texture, *_ = self.make_glow()
        texture.image = self.save(make_hook(128))
        file = self.folder / "map.exr"
        file.write_bytes(file.read_bytes()[:9000])
        texture.image.reload()
        self.assertGreater(self.render("RELIEF", samples=1)["Combined"][..., :3].max(), 0)
        self.assertEqual(len(self.report()), 1, self.report())
        self.assertIn('image "loaded" cannot be used', self.report()[0])
        self.assertIn("it is pink, as in Cycles", self.report()[0])

    def test_an_environment_that_is_not_finite_is_pink_and_named(self):
        tree = bpy.context.scene.world.node_tree
        background = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBackground")
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        tree.links.new(texture.outputs["Color"], background.inputs["Color"])
        texels = np.ones((8, 16, 3), np.float32)
        texels[0, 0, 0] = np.inf
        texture.image = self.save(texels)
        make_material(make_grid(1))
        self.render("RELIEF", samples=1)
        self.assertEqual(len(self.report()), 1, self.report())
        self.assertIn("infinity at column 0, row 0 from the top", self.report()[0])

    def test_a_missing_normal_map_is_none_and_named(self):
        material = make_material(make_grid(1))
        tree = material.node_tree
        texture, node = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeNormalMap")
        texture.image = self.make_missing()
        tree.links.new(texture.outputs["Color"], node.inputs["Color"])
        tree.links.new(node.outputs["Normal"], tree.nodes["Principled BSDF"].inputs["Normal"])
        report = Report()
        scene = SceneExport(bpy.context.evaluated_depsgraph_get(), report).run()
        self.assertNotIn("geometry_normal", scene.materials["material"])
        self.assertIn("/nowhere/gone.png", report)

    # Tiles

    def make_tiles(self, numbers=(1001, 1002, 1011), extension="png", broken=()):
        """A tiled image of bytes: red is the number of the tile, of 16 + 10 per tile."""
        for i, number in enumerate(numbers):
            file = self.folder / f"tile.{number}.{extension}"
            image = make_image("tile", np.full((4, 4, 3), (16 + 10 * i) / 255, np.float32))
            image.filepath_raw, image.file_format = str(file), {"png": "PNG", "exr": "OPEN_EXR"}[extension]
            image.save()
            bpy.data.images.remove(image)
        bpy.ops.image.open(filepath=str(self.folder / f"tile.{numbers[0]}.{extension}"), use_udim_detecting=True)
        image = bpy.data.images[f"tile.<UDIM>.{extension}"]
        image.colorspace_settings.name = "Non-Color"
        self.assertEqual([tile.number for tile in image.tiles], list(numbers))
        for number in broken:
            (self.folder / f"tile.{number}.{extension}").write_bytes(b"no picture")
        return image

    def test_tiles_are_read_and_leave_no_images_behind(self):
        for broken in ((), (1002,)):
            image, lines = self.make_tiles(broken=broken), []
            before = sorted(i.name for i in bpy.data.images)
            tiles = images.read_tiles(image, lines.append)
            found = {number: float(np.round(texels[0, 0, 0] * 255)) for number, texels in tiles.items()}
            self.assertEqual(found, {n: v for n, v in ((1001, 16), (1002, 26), (1011, 36)) if n not in broken})
            self.assertEqual(sorted(i.name for i in bpy.data.images), before)
            self.assertEqual(len(lines), len(broken), lines)
            bpy.data.images.remove(image)

    def test_tiles_of_an_image_that_blender_has_not_read_yet(self):
        for removed in ((), (1001,)):
            self.make_tiles()
            bpy.data.images.remove(bpy.data.images["tile.<UDIM>.png"])
            bpy.ops.image.open(filepath=str(self.folder / "tile.1001.png"), use_udim_detecting=True)
            image = bpy.data.images["tile.<UDIM>.png"]
            for number in removed:
                (self.folder / f"tile.{number}.png").unlink()
            tiles = images.read_tiles(image, lambda text: None)
            self.assertEqual(sorted(tiles), [n for n in (1001, 1002, 1011) if n not in removed])
            self.assertAlmostEqual(float(tiles[1002][0, 0, 0]), float(images.decode_srgb(np.float32(26 / 255))), places=5)
            bpy.data.images.remove(image)

    def test_a_tiled_image_without_its_first_tile_has_the_others(self):
        image, lines = self.make_tiles(), []
        (self.folder / "tile.1001.png").unlink()
        image.buffers_free()
        self.assertEqual(sorted(images.read_tiles(image, lines.append)), [1002, 1011])
        self.assertIn("tiles 1001 of image", lines[0])
        for number in (1002, 1011):
            (self.folder / f"tile.{number}.png").unlink()
        with self.assertRaises(images.MissingImage):
            images.read_tiles(image, print)

    def test_a_cache_reads_tiles_again_only_where_their_files_change(self):
        image, cache = self.make_tiles(), images.TileCache()
        updates = []

        def note(scene, depsgraph):
            updates.append(depsgraph.id_type_updated("IMAGE"))
        bpy.context.view_layer.update()
        bpy.app.handlers.depsgraph_update_post.append(note)
        self.addCleanup(bpy.app.handlers.depsgraph_update_post.remove, note)
        first = images.read_tiles(image, print, cache)
        bpy.context.view_layer.update()
        self.assertIn(True, updates, "Blender takes reading for a change, which is what the cache is for")
        updates.clear()
        again = images.read_tiles(image, print, cache)
        bpy.context.view_layer.update()
        self.assertEqual(updates, [])
        for number, texels in first.items():
            np.testing.assert_array_equal(texels, again[number])
        (self.folder / "tile.1002.png").write_bytes((self.folder / "tile.1011.png").read_bytes() + b"\0")
        self.assertEqual(round(float(images.read_tiles(image, print, cache)[1002][0, 0, 0]) * 255), 36)

    def test_a_cache_forgets_what_is_no_longer_used(self):
        image, cache = self.make_tiles(), images.TileCache()
        images.read_tiles(image, print, cache)
        cache.forget_unused()
        self.assertEqual(len(cache._kept), 2)
        cache.forget_unused()
        self.assertEqual(len(cache._kept), 0)


class Packed(BlenderTest):
    def test_a_packed_exr_is_read_as_a_file_and_written_once(self):
        texels = np.linspace(-1, 2, 6 * 5 * 3, dtype=np.float32).reshape(6, 5, 3)
        image = make_image("packed", texels)
        file = images.find_file(image)
        np.testing.assert_array_equal(relief._relief.read_texture(file)[..., :3], texels)
        with mock.patch.object(images, "open", side_effect=OSError, create=True):
            self.assertEqual(images.find_file(image), file)
        self.assertNotEqual(images.find_file(make_image("other", 2 * texels)), file)

    def test_other_packed_images_are_read_by_blender(self):
        bytes_image = bpy.data.images.new("bytes", 4, 4, is_data=True)
        bytes_image.pack()
        painted = make_image("painted", np.zeros((4, 4, 3), np.float32))
        painted.pixels[0] = 1.0
        self.assertTrue(painted.is_dirty)
        for image in (bytes_image, painted):
            self.assertIsNone(images.find_file(image))


if __name__ == "__main__":
    main()
