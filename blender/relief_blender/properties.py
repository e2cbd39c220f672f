"""Settings of a scene: scene.relief."""
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

ENGINES = [("cpu", "CPU", "All cores, or as many threads as the scene's performance settings say"),
           ("vulkan", "GPU (Vulkan)", "A device with Vulkan 1.2")]


class ReliefSettings(bpy.types.PropertyGroup):
    samples: IntProperty(name="Samples", default=64, min=1, max=1 << 20, description="Samples of each pixel, at most")
    noise: FloatProperty(name="Noise Threshold", default=0.0, min=0.0, max=1.0, precision=3,
                         description="No more samples where the error is below this share of the brightness; 0: all")
    time_limit: FloatProperty(name="Time Limit", default=0.0, min=0.0, subtype="TIME_ABSOLUTE", unit="TIME_ABSOLUTE",
                              description="No more samples after so many seconds; 0: no limit")
    bounces: IntProperty(name="Bounces", default=4, min=0, max=1000,
                         description="0: only light straight from lights. Glass takes 12 or more")
    clamp_indirect: FloatProperty(name="Clamp Indirect", default=10.0, min=0.0,
                                  description="Most that a path adds after its first bounce, which removes specks; 0: all of it")
    pixel_error: FloatProperty(name="Cell Size", default=1.0, min=0.01, max=64.0, subtype="PIXEL",
                               description="Size of the cells of displaced surfaces, in pixels")
    seed: IntProperty(name="Seed", default=0, min=0, description="Of the random numbers")
    engine: EnumProperty(name="Device", items=ENGINES, default="cpu")
    denoise: BoolProperty(name="Denoise", default=False, description="By Open Image Denoise, where it is installed")
    viewport_samples: IntProperty(name="Viewport Samples", default=16, min=1, max=1 << 20)
    viewport_bounces: IntProperty(name="Viewport Bounces", default=2, min=0, max=1000)
    viewport_pixel_error: FloatProperty(name="Viewport Cell Size", default=2.0, min=0.01, max=64.0, subtype="PIXEL",
                                        description="Size of the cells of displaced surfaces in the viewport, in pixels")


def register():
    bpy.utils.register_class(ReliefSettings)
    bpy.types.Scene.relief = PointerProperty(type=ReliefSettings)


def unregister():
    del bpy.types.Scene.relief
    bpy.utils.unregister_class(ReliefSettings)


def find_threads(render):
    """0: all cores."""
    return render.threads if render.threads_mode == "FIXED" else 0
