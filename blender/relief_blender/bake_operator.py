"""The operator "Bake to Map"."""
from contextlib import contextmanager

import bpy
import numpy as np
import relief
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from . import bake, images, mesh_arrays

SPACES = [("TANGENT", "Tangent", "Fits the base also where it bends"), ("OBJECT", "Object", "Along the axes of the object")]


def find_multires(ob):
    return next((m for m in ob.modifiers if m.type == "MULTIRES" and m.total_levels > 0), None)


@contextmanager
def smooth_base(ob, multires, context):
    """The subdivision surface that a multires sculpt lies on, at the sculpt's level, as an evaluated mesh."""
    copy = bpy.data.objects.new("relief base", ob.data.copy())
    data = copy.data
    context.scene.collection.objects.link(copy)
    try:
        modifier = copy.modifiers.new("subdivision", "SUBSURF")
        modifier.levels, modifier.uv_smooth = multires.total_levels, multires.uv_smooth
        modifier.boundary_smooth, modifier.use_creases = multires.boundary_smooth, multires.use_creases
        modifier.quality = multires.quality
        yield copy.evaluated_get(context.evaluated_depsgraph_get()).data
    finally:
        bpy.data.objects.remove(copy)
        bpy.data.meshes.remove(data)


def read_detailed(ob, base_ob, depsgraph):
    """The evaluated mesh of an object in the axes of the base."""
    if base_ob.matrix_world.determinant() == 0:
        raise bake.BakeError(f'"{base_ob.name}" has a scale of zero: give it another, or apply it')
    evaluated = ob.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        arrays = mesh_arrays.read_mesh(mesh)
    finally:
        evaluated.to_mesh_clear()
    matrix = np.array(base_ob.matrix_world.inverted() @ ob.matrix_world)
    positions = (arrays.positions @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)
    return relief.Mesh(positions, (arrays.sizes, arrays.corners))


def assign(ob, image, space):
    """The map at the displacement of the object's material."""
    material = ob.active_material or bpy.data.materials.new(ob.name)
    if ob.active_material is None:
        ob.active_material = material
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeVectorDisplacement")
    node.space = space
    node.inputs["Midlevel"].default_value, node.inputs["Scale"].default_value = 0.0, 1.0
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], node.inputs["Vector"])
    output = tree.get_output_node("ALL") or tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs["Displacement"], output.inputs["Displacement"])
    material.displacement_method = "DISPLACEMENT"


def replace_multires(ob, multires):
    """The sculpt is hidden, and a subdivision surface in its place carries the map."""
    multires.show_viewport = multires.show_render = False
    modifier = ob.modifiers.new("Base of the map", "SUBSURF")
    modifier.levels = modifier.render_levels = min(multires.total_levels, 3)
    modifier.uv_smooth, modifier.boundary_smooth = multires.uv_smooth, multires.boundary_smooth


class RELIEF_OT_bake_map(bpy.types.Operator):
    """Bake the shape of a multires sculpt, or of the other selected mesh, to a vector displacement map of the active object"""
    bl_idname = "relief.bake_map"
    bl_label = "Bake to Map"
    bl_options = {"REGISTER", "UNDO"}

    width: IntProperty(name="Width", default=1024, min=1, max=65536)
    height: IntProperty(name="Height", default=1024, min=1, max=65536)
    space: EnumProperty(name="Space", items=SPACES)
    margin: IntProperty(name="Margin", default=8, min=0, max=1024, subtype="PIXEL", description="Around uv islands")
    distance: FloatProperty(name="Ray Distance", default=0.0, min=0.0, unit="LENGTH",
                            description="Of rays at most; 0: half the diagonal of the detailed mesh")
    use_result: BoolProperty(name="Use the Map", default=True,
                             description="Put the map into the material, and a subdivision surface in the place of the sculpt")

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and context.object is not None and context.object.type == "MESH"

    def invoke(self, context, event):
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context):
        settings = bake.BakeSettings(self.width, self.height, self.margin, self.space, self.distance)
        ob = context.object
        others = [o for o in context.selected_objects if o != ob and o.type == "MESH"]
        multires = find_multires(ob)
        try:
            if others:
                texels = self._bake_other(context, ob, others[0], settings)
            elif multires is not None:
                texels = self._bake_multires(context, ob, multires, settings)
            else:
                raise bake.BakeError("select the detailed mesh too, or sculpt with a Multiresolution modifier")
        except (bake.BakeError, relief.Error) as fault:
            self.report({"ERROR"}, str(fault))
            return {"CANCELLED"}
        image = images.make_image(f"{ob.name} displacement", texels)
        if self.use_result:
            assign(ob, image, self.space)
            if multires is not None and not others:
                replace_multires(ob, multires)
        self.report({"INFO"}, f'image "{image.name}": displacements up to {np.linalg.norm(texels, axis=-1).max():.4g}')
        return {"FINISHED"}

    def _bake_other(self, context, ob, other, settings):
        depsgraph = context.evaluated_depsgraph_get()
        base = bake.read_base(ob.evaluated_get(depsgraph).data)
        raster = bake.make_raster(base, settings, self._warn)
        texels, missed = bake.bake_by_rays(raster, base, read_detailed(other, ob, depsgraph), settings)
        if missed > 0:
            self._warn(f"rays of {100 * missed:.2g} % of the texels found nothing: 0 there")
        return texels

    def _warn(self, text):
        self.report({"WARNING"}, text)

    def _bake_multires(self, context, ob, multires, settings):
        levels = multires.levels
        multires.levels = multires.total_levels
        try:
            moved = mesh_arrays.read(ob.evaluated_get(context.evaluated_depsgraph_get()).data.vertices, "co", 3)
        finally:
            multires.levels = levels
        with smooth_base(ob, multires, context) as mesh:
            base = bake.read_base(mesh)
            if len(mesh.vertices) != len(moved):
                raise bake.BakeError("other modifiers change the sculpt: apply or remove them")
        return bake.bake_by_points(bake.make_raster(base, settings, self._warn), base, moved, settings)


def register():
    bpy.utils.register_class(RELIEF_OT_bake_map)


def unregister():
    bpy.utils.unregister_class(RELIEF_OT_bake_map)
