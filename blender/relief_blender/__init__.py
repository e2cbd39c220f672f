"""Relief for Blender: a render engine that ray traces vector-displaced surfaces without tessellating them."""
import atexit

import bpy

from . import bake_operator, engine, panels, properties, statistics

# In the order in which they need each other.
_MODULES = [properties, statistics, bake_operator, engine, panels]


def register():
    for module in _MODULES:
        module.register()
    if not bpy.app.binary_path:  # as a Python module Blender never ends while classes are registered
        atexit.register(unregister)


def unregister():
    atexit.unregister(unregister)
    for module in reversed(_MODULES):
        module.unregister()
