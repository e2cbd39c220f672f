"""Panels of the render properties."""
import bpy

from . import statistics


class _ReliefPanel:
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"

    @classmethod
    def poll(cls, context):
        return context.engine == "RELIEF"

    def rows(self, context, *names):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in names:
            self.layout.prop(context.scene.relief, name)


class RELIEF_PT_sampling(_ReliefPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context):
        self.rows(context, "samples", "noise", "time_limit", "denoise", "seed")


class RELIEF_PT_light_paths(_ReliefPanel, bpy.types.Panel):
    bl_label = "Light Paths"

    def draw(self, context):
        self.rows(context, "bounces", "clamp_indirect")


class RELIEF_PT_surfaces(_ReliefPanel, bpy.types.Panel):
    bl_label = "Displaced Surfaces"

    def draw(self, context):
        self.rows(context, "pixel_error")
        self.layout.operator("relief.bake_map")


class RELIEF_PT_motion_blur(_ReliefPanel, bpy.types.Panel):
    """Blender's own settings, which each engine has a panel of its own for."""
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        render = context.scene.render
        self.layout.use_property_split = True
        self.layout.active = render.use_motion_blur
        self.layout.prop(render, "motion_blur_position", text="Position")
        self.layout.prop(render, "motion_blur_shutter")


class RELIEF_PT_object_motion_blur(_ReliefPanel, bpy.types.Panel):
    """The settings that objects have for Cycles."""
    bl_label = "Motion Blur"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.object, "cycles")

    def draw_header(self, context):
        self.layout.active = context.scene.render.use_motion_blur
        self.layout.prop(context.object.cycles, "use_motion_blur", text="")

    def draw(self, context):
        own = context.object.cycles
        self.layout.use_property_split = True
        self.layout.active = context.scene.render.use_motion_blur and own.use_motion_blur
        self.layout.prop(own, "motion_steps", text="Steps")
        if context.object.type not in {"CAMERA", "LIGHT"}:
            self.layout.prop(own, "use_deform_motion", text="Deformation")


class RELIEF_PT_viewport(_ReliefPanel, bpy.types.Panel):
    bl_label = "Viewport"

    def draw(self, context):
        self.rows(context, "viewport_samples", "viewport_bounces", "viewport_pixel_error")


class RELIEF_PT_device(_ReliefPanel, bpy.types.Panel):
    bl_label = "Device"

    def draw(self, context):
        self.rows(context, "engine")
        render = context.scene.render
        self.layout.prop(render, "threads_mode")
        column = self.layout.column()
        column.enabled = render.threads_mode == "FIXED"
        column.prop(render, "threads")


class RELIEF_PT_film(_ReliefPanel, bpy.types.Panel):
    bl_label = "Film"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.scene.render, "film_transparent", text="Transparent")


class RELIEF_PT_statistics(_ReliefPanel, bpy.types.Panel):
    bl_label = "Relief Statistics"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        found = statistics.find(context.scene)
        if found is None:
            self.layout.label(text="No render yet")
            return
        if found.fault:
            self.layout.label(text=found.fault, icon="ERROR")
        else:
            for label, text in statistics.describe(found.statistics):
                row = self.layout.split(factor=0.5)
                row.label(text=label)
                row.label(text=text)
        if found.lines:
            self.layout.label(text="Not taken over:", icon="INFO")
        for line in found.lines:
            self.layout.label(text=line)


class RELIEF_PT_passes(_ReliefPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        self.layout.use_property_split = True
        for name in ("use_pass_z", "use_pass_position", "use_pass_normal", "use_pass_uv", "use_pass_diffuse_color",
                     "use_pass_emit", "use_pass_environment", "use_pass_cryptomatte_object",
                     "use_pass_cryptomatte_material"):
            self.layout.prop(context.view_layer, name)


CLASSES = [RELIEF_PT_sampling, RELIEF_PT_light_paths, RELIEF_PT_surfaces, RELIEF_PT_motion_blur,
           RELIEF_PT_object_motion_blur, RELIEF_PT_viewport, RELIEF_PT_device, RELIEF_PT_film, RELIEF_PT_passes,
           RELIEF_PT_statistics]


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
