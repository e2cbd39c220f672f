"""Relief for Blender: a render engine that ray traces vector-displaced surfaces without tessellating them."""
from . import bake_operator, engine, panels, properties, statistics

# In the order in which they need each other.
_MODULES = [properties, statistics, bake_operator, engine, panels]


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
