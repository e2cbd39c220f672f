"""The life of the add-on: registering, what is kept of renders."""
from support import BlenderTest, main, make_grid, make_material  # first: it makes the add-on known
from unittest import mock

import bpy
import relief_blender
from relief_blender import scene_export, statistics


class Engine(BlenderTest):
    def test_it_registers_and_unregisters_cleanly(self):
        relief_blender.unregister()
        self.assertFalse(hasattr(bpy.types.Scene, "relief"))
        self.assertFalse(any("RELIEF" in getattr(p, "COMPAT_ENGINES", ()) for p in bpy.types.Panel.__subclasses__()))
        with self.assertRaises(TypeError):
            bpy.context.scene.render.engine = "RELIEF"
        relief_blender.register()
        bpy.context.scene.render.engine = "RELIEF"
        self.assertGreater(bpy.context.scene.relief.samples, 0)

    def test_statistics_and_report_are_kept_for_the_panel(self):
        make_material(make_grid(3), Subsurface_Weight=0.5)
        self.render("RELIEF")
        found, lines, fault = statistics.find(bpy.context.scene)
        self.assertEqual((len(lines), fault), (1, ""))
        labels = dict(statistics.describe(found))
        self.assertEqual((labels["Instances"], labels["Triangles"]), ("1", "18"), labels)
        self.assertNotEqual(labels["Peak of the process"], "0.0 MiB")
        self.assertTrue(labels["Device"])

    def test_lines_and_faults_of_all_view_layers_are_kept(self):
        scene = bpy.context.scene
        collection = bpy.data.collections.new("own")
        scene.collection.children.link(collection)
        make_material(make_grid(1), Subsurface_Weight=0.5).name = "everywhere"
        first = make_grid(1)
        make_material(first, Subsurface_Weight=0.5).name = "first"
        scene.collection.objects.unlink(first)
        collection.objects.link(first)
        scene.view_layers.new("second").layer_collection.children["own"].exclude = True
        scene.frame_start, scene.frame_end = 1, 2
        scene.render.filepath, scene.relief.samples, scene.render.engine = str(self.folder / "f"), 1, "RELIEF"
        for _ in range(2):
            bpy.ops.render.render(animation=True)
            self.assertEqual(sorted(line.split('"')[1] for line in self.report()), ["everywhere", "first"])
        first.data.materials[0].node_tree.nodes["Principled BSDF"].inputs["Subsurface Weight"].default_value = 0
        bpy.ops.render.render()
        self.assertEqual([line.split('"')[1] for line in self.report()], ["everywhere"])
        run = scene_export.SceneExport.run
        with mock.patch.object(scene_export.SceneExport, "run", autospec=True, side_effect=lambda exporter: run(exporter)
                               if exporter._depsgraph.view_layer.name == "second" else 1 / 0), \
                self.assertRaises(RuntimeError):
            bpy.ops.render.render()
        self.assertIn("ZeroDivisionError", statistics.find(scene).fault)

    def test_statistics_are_those_of_a_scene_and_not_of_its_name(self):
        make_grid(2)
        self.render("RELIEF", samples=1)
        scene = bpy.context.scene
        scene.name, other = "renamed", bpy.data.scenes.new("Scene")
        self.assertIsNotNone(statistics.find(scene))
        self.assertIsNone(statistics.find(other))

    def test_statistics_are_forgotten_with_their_file(self):
        make_grid(2)
        self.render("RELIEF", samples=1)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "a.blend"))
        self.assertEqual(len(statistics._kept), 1)
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "a.blend"))
        self.assertEqual(len(statistics._kept), 0)
        self.assertIsNone(statistics.find(bpy.context.scene))
        relief_blender.unregister()
        self.assertFalse([f for f in bpy.app.handlers.load_post if f.__module__.startswith("relief_blender")])
        relief_blender.register()


if __name__ == "__main__":
    main()
