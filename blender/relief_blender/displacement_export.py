"""Vector Displacement and Displacement nodes as displacements of Relief."""
from typing import NamedTuple

import numpy as np
import relief

from . import axes, images, values
from .node_tree import NotExpressible, Wire, follow
from .node_values import NodeValues
from .textures import LARGEST
from .values import Constant, Place, Textured

# As the node has them: red along the tangent, green along the normal, blue along the bitangent.
AXES = {"TANGENT": "t,n,b", "OBJECT": "x,y,z", "WORLD": axes.WORLD_AXES}


class ReadDisplacement(NamedTuple):
    value: Textured  # what the node's main input gets
    midlevel: float
    scale: float
    space: str  # TANGENT, OBJECT or WORLD
    is_height: bool

    @property
    def is_world_height(self):
        """Its length is that of the world, and not of the object's own axes."""
        return self.is_height and self.space == "WORLD"

    @property
    def is_tangent(self):
        return self.is_height or self.space == "TANGENT"

    def write(self, texels):
        """The displacement. Files stay files; all else becomes an array."""
        keys = {"midlevel": self.midlevel, "scale": self.scale, "type": "height" if self.is_height else "vector"}
        if not self.is_height:
            keys.update(space=self.space.lower(), axes=AXES[self.space])
        place = self.value.place
        if place.filter != "none":
            keys["filter"] = place.filter
        file = self._find_file()
        if file is None:
            tiles = texels.tiles(self.value)
            tiles = {n: np.ascontiguousarray(t[..., :1] if self.is_height else t, np.float32) for n, t in tiles.items()}
            is_tiled = list(tiles) != [1001]
            file = tiles if is_tiled else tiles[1001]
        else:
            is_tiled = "<UDIM>" in file
        if not is_tiled:
            keys["wrap"] = place.wrap
        return relief.Displacement(file, **keys)

    def _find_file(self):
        """Vectors are read from the file itself; heights, which are luminances, through Blender."""
        value = self.value
        is_own = value.tiles is None and value.image is not None and not value.channel and np.all(value.factor == 1)
        return images.find_file(value.image) if is_own and not self.is_height else None


class DisplacementReader:
    """Reads what a material's output displaces by. `report` takes a text."""

    def __init__(self, material, node_values, report):
        self._material, self._report = material, report
        self._values = NodeValues(report, node_values.texels, missing=None)

    def read(self, output):
        """A ReadDisplacement, or None: there is none, or it is named in the report."""
        try:
            source = follow(Wire(output.inputs["Displacement"]))
            if source.node is None:
                return None
            method = self._material.displacement_method
            if method == "BUMP":
                self._report("its displacement is Bump Only, which is not taken over: choose Displacement Only")
                return None
            if method == "BOTH":
                self._report("Displacement and Bump: the displacement has all the detail, the bump is left out")
            return self._read_node(source)
        except images.MissingImage as fault:
            self._report("displacement: " + fault.tell("nothing is displaced by it"))
            return None
        except NotExpressible as fault:
            self._report(f"displacement: {fault} is not taken over")
            return None

    def _read_node(self, source):
        node = source.node
        if node.bl_idname not in {"ShaderNodeVectorDisplacement", "ShaderNodeDisplacement"}:
            raise NotExpressible(f'node "{node.bl_label}"')
        is_height = node.bl_idname == "ShaderNodeDisplacement"
        if is_height and source.input("Normal").socket.is_linked:
            raise NotExpressible("its own normal")
        wire = source.input("Height" if is_height else "Vector")
        value = self._values.number(wire) if is_height else self._values.color(wire)
        midlevel = self._values.constant(source.input("Midlevel"))
        scale = self._values.number(source.input("Scale"))
        if isinstance(scale, Textured):
            value = values.combine(lambda v, s: (v - midlevel) * s, [value, scale], self._values.texels)
            midlevel, scale = 0.0, values.make_constant(1)
        if isinstance(value, Textured) and value.tiles and not all(np.all(np.isfinite(t)) for t in value.tiles.values()):
            raise NotExpressible("a computation whose texels are not finite")
        numbers = [midlevel, scale.number, *(value.rgb if isinstance(value, Constant) else value.factor)]
        if not np.all(np.abs(numbers) < LARGEST):  # NaN is not
            raise NotExpressible("a scale, midlevel or value that is not finite")
        if isinstance(value, Constant):
            tiles = {1001: value.rgb.reshape(1, 1, 3)}
            value = Textured(Place(wrap="clamp"), tiles=tiles)
        return ReadDisplacement(self._check_place(value), midlevel, scale.number, node.space, is_height)

    def _check_place(self, value):
        if min(value.place.scale) <= 0:
            raise NotExpressible("a mapping that turns or mirrors its image")
        return value
