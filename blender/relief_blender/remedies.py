"""Warnings of Relief with remedies that exist in Blender, in place of keys of a scene file."""
import re

COLORS = ("Red", "Green", "Blue")
NODE_ORDERS = ("tnb", "xyz")  # what the node Vector Displacement has in red, green and blue


def _describe_axes(axes):
    """How channels are to be put in the order of the node."""
    names = axes.split(",")
    letters = [name.lstrip("-+") for name in names]
    order = next((o for o in NODE_ORDERS if sorted(o) == sorted(letters)), None)
    if order is None:
        return "put the channels in the order of the node by Separate Color and Combine Color"
    parts = []
    for color, letter in zip(COLORS, order):
        at = letters.index(letter)
        parts.append(f"{color} from {'minus ' if names[at].startswith('-') else ''}{COLORS[at]}")
    return "put Separate Color and Combine Color between the image and the displacement node: " + ", ".join(parts)


def _describe_encoding(name):
    if name == "signed":
        return "export the map with negative values, or set Midlevel of the displacement node"
    return f'set Color Space of the image to {"sRGB" if name == "srgb" else "Non-Color"}'


KEY = r"(?:write |set )?(?:displacement\.)?"
_REMEDIES = [
    (KEY + r"space = (\w+)", lambda m: f"set Space of the node Vector Displacement to {m[1].title()} Space"),
    (KEY + r"wrap = (\w+)",
     lambda m: f"set Extension of the node Image Texture to {'Repeat' if m[1] == 'repeat' else 'Extend'}"),
    (KEY + r"midlevel = R,G,B", lambda m: "subtract the colour of the border before the displacement node"),
    (KEY + r"midlevel = ([-+.\de]+)", lambda m: f"set Midlevel of the displacement node to {m[1]}"),
    (KEY + r"flip_v = \w+", lambda m: "turn the image upside down (Image > Flip > Vertically)"),
    (KEY + r"type = height", lambda m: "use the node Displacement instead of Vector Displacement"),
    (KEY + r"encoding = (\w+)", lambda m: _describe_encoding(m[1])),
    (KEY + r"axes = ([-+\w]+,[-+\w]+,[-+\w]+)(?:, as presets [\w-]+(?:, [\w-]+)*)?", lambda m: _describe_axes(m[1])),
    (KEY + r"axes to an order with ([RGB]) along (-?)n: the values do not show which of the other two is along t(?: \([^)]*\))?",
     lambda m: f"put Separate Color and Combine Color between the image and the displacement node: Green from {'minus ' if m[2] else ''}"
     f"{COLORS['RGB'.index(m[1])]}, Red and Blue from the other two"),
    (r"set displacement\.scale", lambda m: "set Scale of the displacement node"),
    (r"name all tiles as <UDIM>", lambda m: "set Source of the image to UDIM Tiles"),
    (r",? or inspect the map", lambda m: ""),
]


def translate(warning):
    """A warning of the library as Blender's users can follow it."""
    for pattern, remedy in _REMEDIES:
        warning = re.sub(pattern, remedy, warning)
    return re.sub(r"displacement '([^']*)'", r'the displacement of material "\1"', warning)
