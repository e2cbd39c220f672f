"""Light linking: each thing is as bright as by Cycles, whatever comes first in the scene."""
from support import BlenderTest, add_light, main, make_grid, set_world  # first: it makes the add-on known
import bpy
import numpy as np
from relief_blender.report import Report
from relief_blender.scene_export import SceneExport


def link(light, *links):
    """Objects and collections with INCLUDE or EXCLUDE."""
    collection = bpy.data.collections.new("receivers")
    light.light_linking.receiver_collection = collection
    for thing, state in links:
        if isinstance(thing, bpy.types.Collection):
            collection.children.link(thing)
            entry = collection.collection_children[-1]
        else:
            collection.objects.link(thing)
            entry = collection.collection_objects[-1]
        entry.light_linking.link_state = state
    return collection


class Links(BlenderTest):
    """Three panes side by side, left, middle and right, and a sun behind the camera."""

    def setUp(self):
        super().setUp()
        set_world(bpy.context.scene.world, (0, 0, 0))
        self.light = add_light("SUN", (0, -6, 3), (0, 0, 0), energy=2.0)  # it comes before all that it lights
        self.panes = {}
        for name, x in (("left", -1.5), ("middle", 0.0), ("right", 1.5)):
            pane = make_grid(1)
            pane.name, pane.location, pane.scale = name, (x, 0, 0), (0.6, 0.6, 1)
            pane.rotation_euler = (1.1, 0, 0)
            self.panes[name] = pane

    def find_lit(self, layers):
        """Names of the panes that are lit, by thirds of the picture."""
        thirds = np.array_split(layers["Combined"][..., :3].mean(-1), 3, axis=1)
        return [name for name, third in zip(self.panes, thirds) if third.mean() > 0.01]

    def check(self, *names):
        ours, theirs = self.render("RELIEF", samples=4), self.render("CYCLES", samples=4)
        self.assertEqual(self.find_lit(theirs), list(names), "by Cycles")
        self.assertEqual(self.find_lit(ours), list(names))

    def test_without_links_all_are_lit(self):
        self.check("left", "middle", "right")

    def test_receivers_that_come_after_the_light(self):
        link(self.light, (self.panes["right"], "INCLUDE"), (self.panes["left"], "INCLUDE"))
        self.check("left", "right")

    def test_what_is_excluded_after_the_light(self):
        link(self.light, (self.panes["middle"], "EXCLUDE"))
        self.check("left", "right")

    def test_collections_among_the_receivers(self):
        inner = bpy.data.collections.new("inner")
        inner.objects.link(self.panes["left"])
        link(self.light, (inner, "INCLUDE"))
        self.check("left")
        inner.objects.link(self.panes["middle"])
        self.light.light_linking.receiver_collection.collection_children[0].light_linking.link_state = "EXCLUDE"
        self.check("right")

    def test_a_light_whose_receivers_are_hidden_lights_nothing(self):
        link(self.light, (self.panes["middle"], "INCLUDE"))
        self.panes["middle"].hide_render = True
        self.check()

    def test_instances_are_linked_by_their_object_or_by_their_instancer(self):
        for name in ("left", "right"):
            bpy.context.scene.collection.objects.unlink(self.panes[name])
        collection = bpy.data.collections.new("panes")
        collection.objects.link(self.panes["left"])
        self.panes["left"].location = (0, 0, 0)
        for name, x in (("left", -1.5), ("right", 1.5)):
            empty = bpy.data.objects.new(f"{name} empty", None)
            empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", collection, (x, 0, 0)
            bpy.context.scene.collection.objects.link(empty)
        receivers = link(self.light, (self.panes["left"], "INCLUDE"))
        self.check("left", "right")
        receivers.objects.unlink(self.panes["left"])
        for name in ("left", "right"):
            receivers.objects.link(bpy.data.objects[f"{name} empty"])
        self.check("left", "right")

    def test_shadow_linking_and_links_of_what_emits_are_named(self):
        self.light.light_linking.blocker_collection = bpy.data.collections.new("blockers")
        self.panes["left"].light_linking.receiver_collection = bpy.data.collections.new("receivers")
        report = Report()
        SceneExport(bpy.context.evaluated_depsgraph_get(), report).run()
        self.assertIn("shadow linking", report)
        self.assertTrue(any('object "left": light linking' in line for line in report.lines), report.lines)


if __name__ == "__main__":
    main()
