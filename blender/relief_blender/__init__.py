"""Relief for Blender: a render engine that ray traces vector-displaced surfaces without tessellating them."""
import atexit

import bpy

from . import bake_operator, engine, panels, properties, statistics

# In the order in which they need each other.
_MODULES = [properties, statistics, bake_operator, engine, panels]


_registered = False


def register():
    global _registered
    _registered = True
    for module in _MODULES:
        module.register()
    if not bpy.app.binary_path:  # as a Python module Blender never ends while classes are registered
        atexit.register(unregister)


def unregister():
    """Once: where Blender is a Python module, both the end of Python and Blender's own end call this."""
    global _registered
    atexit.unregister(unregister)
    if not _registered:
        return
    _registered = False
    for module in reversed(_MODULES):
        module.unregister()
