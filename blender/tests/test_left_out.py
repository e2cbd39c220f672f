"""What a file may hold that is not an ordinary scene: it is rendered as by Cycles, or left out and named."""
from support import BlenderTest, main, make_grid, make_material  # first: it makes the add-on known
import bpy
import numpy as np
from relief_blender.report import Report
from relief_blender.scene_export import SceneExport


class Modes(BlenderTest):
    def check_in_edit_mode(self, ob):
        """In Edit Mode an object is seen as it was before, by Cycles too."""
        before = self.render("RELIEF", "before", samples=4)
        bpy.context.view_layer.objects.active = ob
        bpy.ops.object.mode_set(mode="EDIT")
        try:
            ours, theirs = self.render("RELIEF", "edit", samples=4), self.render("CYCLES", "edit", samples=4)
        finally:
            bpy.ops.object.mode_set(mode="OBJECT")
        self.assertGreater(before.mask.mean(), 0.03)
        for other in (before, theirs):
            self.assertLess(np.mean(ours.mask != other.mask), 0.01)
        self.assertEqual(self.report(), [])

    def test_a_mesh_in_edit_mode_is_seen(self):
        ob = make_grid(2)
        make_material(ob)
        self.check_in_edit_mode(ob)

    def test_modifiers_of_a_mesh_in_edit_mode_are_applied(self):
        ob = make_grid(2)
        make_material(ob)
        ob.scale = (0.5, 0.5, 0.5)
        ob.modifiers.new("array", "ARRAY")
        self.check_in_edit_mode(ob)

    def test_a_subdivision_of_two_materials_in_edit_mode_is_seen(self):
        ob = make_grid(2)
        make_material(ob), make_material(ob)
        ob.data.polygons[1].material_index = 1
        ob.modifiers.new("subdivision", "SUBSURF")
        self.check_in_edit_mode(ob)


class Materials(BlenderTest):
    def export(self):
        exporter = SceneExport(bpy.context.evaluated_depsgraph_get(), Report())
        return exporter.run()

    def test_a_material_called_default_is_not_that_of_objects_without_one(self):
        for names in (("with", "without"), ("without", "with")):  # whichever is taken over first
            for name in names:
                ob = make_grid(1)
                ob.name = name
                if name == "with":
                    make_material(ob, Base_Color=(1, 0, 0)).name = "default"
            scene = self.export()
            colors = {o["name"]: scene.materials[o["material"]]["base_color"] for o in scene.objects}
            np.testing.assert_allclose(colors["with"], [1, 0, 0], atol=1e-6)
            np.testing.assert_allclose(colors["without"], [0.8, 0.8, 0.8], atol=1e-6)
            for ob in [bpy.data.objects[name] for name in names]:
                bpy.data.objects.remove(ob)
            bpy.data.materials.remove(bpy.data.materials["default"])


if __name__ == "__main__":
    main()
