"""Shader nodes as OpenPBR inputs: {key: value}, values not yet written as textures."""
import numpy as np

from . import values
from .node_tree import NotExpressible, follow
from .values import Constant, make_constant

BLACK = make_constant(0)
ONE = make_constant(1)
# Light that the sheen of Cycles reflects under a uniform sky, relative to the fuzz of Relief, by roughness: measured.
SHEEN_FACTORS = ([0.0, 0.1, 0.3, 0.5, 0.75, 1.0], [0.0, 0.0255, 0.215, 0.59, 1.208, 1.841])
# What a material is where its shader cannot be taken over: grey, never black.
FALLBACK = {"base_color": make_constant([0.8, 0.8, 0.8])}


def is_zero(value):
    return isinstance(value, Constant) and bool(np.all(value.rgb == 0))


def match_mean_reflection(ior):
    """The ior whose Fresnel term by Schlick, which Relief has, reflects as much of a uniform sky as the exact one of `ior`."""
    cosine = np.sqrt((np.arange(256) + 0.5) / 256)  # as often as surfaces under such a sky see it
    below = np.sqrt(1 - (1 - cosine ** 2) / ior ** 2)
    mean = np.mean((((cosine - ior * below) / (cosine + ior * below)) ** 2
                    + ((ior * cosine - below) / (ior * cosine + below)) ** 2) / 2)
    straight = np.sqrt(np.clip((21 * mean - 1) / 20, 0, 0.99))
    return float((1 + straight) / (1 - straight))


class Shaders:
    """Reads the surface of one material. `report` takes a text."""

    def __init__(self, node_values, report):
        self._values, self._report = node_values, report
        self._nodes = {
            "ShaderNodeBsdfPrincipled": self._principled, "ShaderNodeBsdfDiffuse": self._diffuse,
            "ShaderNodeBsdfGlossy": self._glossy, "ShaderNodeBsdfAnisotropic": self._glossy,
            "ShaderNodeBsdfMetallic": self._metallic,
            "ShaderNodeBsdfGlass": self._glass, "ShaderNodeBsdfRefraction": self._glass,
            "ShaderNodeEmission": self._emission, "ShaderNodeBsdfTransparent": self._transparent,
            "ShaderNodeMixShader": self._mix, "ShaderNodeAddShader": self._add,
            "ShaderNodeSubsurfaceScattering": self._plain, "ShaderNodeBsdfTranslucent": self._plain,
            "ShaderNodeBsdfToon": self._plain, "ShaderNodeBsdfSheen": self._sheen,
            "ShaderNodeBackground": self._emission,
        }

    def surface(self, wire):
        source = follow(wire)
        if source.node is None:
            return {"base_color": BLACK, "ior": ONE}
        visit = self._nodes.get(source.node.bl_idname)
        if visit is None:
            self._report(f'shader "{source.node.bl_label}" is grey')
            return dict(FALLBACK)
        return visit(source)

    def _read(self, source, name, default=0.0, is_number=True):
        """The value of an input; what cannot be expressed is named, and the socket's own value taken."""
        wire = source.input(name)
        if wire is None:
            return make_constant(default)
        try:
            return self._values.number(wire) if is_number else self._values.color(wire)
        except NotExpressible as fault:
            self._report(f"{name}: {fault} is not taken over")
            own = getattr(wire.socket, "default_value", default)
            return make_constant(own if isinstance(own, (int, float)) else list(own))

    def _number(self, source, name, default=0.0):
        value = self._read(source, name, default)
        if isinstance(value, Constant):
            return value.number
        self._report(f"{name}: a texture of it is not taken over")
        return float(source.input(name).socket.default_value)

    def _color(self, source, name, default=(1, 1, 1)):
        return self._read(source, name, default, is_number=False)

    def _normal(self, source):
        """Keys of the input Normal, where it is a tangent-space normal map."""
        wire = source.input("Normal")
        try:
            node = follow(wire) if wire else None
            if node is None or node.node is None:
                return {}
            if node.node.bl_idname != "ShaderNodeNormalMap" or node.node.space != "TANGENT":
                raise NotExpressible(f'node "{node.node.bl_label}"')
            color = self._values.color(node.input("Color"))
            if isinstance(color, Constant):
                return {}
            uv_map = node.node.uv_map
            if uv_map and color.place.uv_map not in ("", uv_map):
                raise NotExpressible("a normal map whose image lies on another uv map")
            return {"normal": (color, self._values.constant(node.input("Strength")))}
        except NotExpressible as fault:
            self._report(f"Normal: {fault} is not taken over")
            return {}

    # Shaders

    def _principled(self, source):
        report_used = (("Subsurface Weight", "subsurface"), ("Anisotropic", "anisotropy"),
                       ("Thin Film Thickness", "thin film"))
        for name, label in report_used:
            if not is_zero(self._read(source, name)):
                self._report(f"{label} is not taken over")
        if (wire := source.input("Coat Normal")) and wire.socket.is_linked:
            self._report("Coat Normal is not taken over")
        base, metallic, ior = self._color(source, "Base Color"), self._read(source, "Metallic"), self._ior(source)
        keys = {"base_color": base, "metallic": metallic,
                "roughness": self._read(source, "Roughness"), "opacity": self._read(source, "Alpha", 1),
                "base_diffuse_roughness": self._read(source, "Diffuse Roughness"),
                "specular_color": self._tint(source, ior, metallic), "ior": make_constant(ior),
                **self._normal(source)}
        self._add_emission(source, keys)
        self._add_layers(source, keys)
        transmission = self._read(source, "Transmission Weight")
        if not is_zero(transmission):
            keys["transmission_weight"] = transmission
            keys["transmission_color"] = values.combine(lambda c: np.sqrt(np.maximum(c, 0)), [base], self._values.texels)
        return keys

    def _ior(self, source):
        """The ior after Specular IOR Level, which scales the reflection straight on: 0.5 leaves it."""
        ior = max(self._number(source, "IOR", 1.5), 1e-3)
        level = self._number(source, "Specular IOR Level", 0.5)
        reflection = np.clip(((ior - 1) / (ior + 1)) ** 2 * 2 * level, 0, 0.99)
        result = (1 + np.sqrt(reflection)) / (1 - np.sqrt(reflection))
        if ior < 1:
            self._report(f"IOR {ior:g} below 1 is its inverse")
        return float(result)

    def _tint(self, source, ior, metallic):
        """Specular Tint: of metals Relief's too. Of a dielectric Blender tints the reflection straight on alone, Relief all
        of it, so that it gets what tints their mean alike."""
        tint = self._color(source, "Specular Tint")
        if not isinstance(metallic, Constant) or metallic.number == 1:
            return tint
        straight = ((ior - 1) / (ior + 1)) ** 2
        rest = (1 - straight) / 21  # the mean of Schlick's term
        part = (1 - metallic.number) * rest / (straight + rest)
        return values.combine(lambda t: t + part * (1 - t), [tint], self._values.texels)

    def _add_emission(self, source, keys):
        strength = self._read(source, "Emission Strength")
        if is_zero(strength):
            return
        emission = values.multiply(self._color(source, "Emission Color"), strength, self._values.texels)
        if not is_zero(emission):
            keys["emission"] = emission

    def _add_layers(self, source, keys):
        coat = self._read(source, "Coat Weight")
        if not is_zero(coat):
            # Relief's base lies in the coat, Cycles' in air: an ior as much larger reflects the same.
            part = coat.number if isinstance(coat, Constant) else 1.0
            coat_ior = match_mean_reflection(max(self._number(source, "Coat IOR", 1.5), 1.0))
            keys["ior"] = make_constant(keys["ior"].number * (1 + part * (coat_ior - 1)))
            keys.update(coat_weight=coat, coat_roughness=self._read(source, "Coat Roughness"),
                        coat_color=self._color(source, "Coat Tint"), coat_darkening=BLACK,
                        coat_ior=make_constant(coat_ior))
        sheen = self._read(source, "Sheen Weight")
        if not is_zero(sheen):
            roughness = self._read(source, "Sheen Roughness", 0.5)
            at = roughness.number if isinstance(roughness, Constant) else 0.5
            factor = make_constant(np.interp(at, *SHEEN_FACTORS))
            weight = values.multiply(sheen, factor, self._values.texels)
            if isinstance(weight, Constant):
                weight = make_constant(min(weight.number, 1.0))
            keys.update(fuzz_weight=weight, fuzz_roughness=roughness,
                        fuzz_color=self._color(source, "Sheen Tint"))

    def _diffuse(self, source):
        return {"base_color": self._color(source, "Color"), "ior": ONE,
                "base_diffuse_roughness": self._read(source, "Roughness"), **self._normal(source)}

    def _plain(self, source):
        self._report(f'shader "{source.node.bl_label}" is a diffuse one of its colour')
        return {"base_color": self._color(source, "Color"), "ior": ONE, **self._normal(source)}

    def _sheen(self, source):
        return {"base_color": BLACK, "ior": ONE, "fuzz_weight": ONE, "fuzz_color": self._color(source, "Color"),
                "fuzz_roughness": self._read(source, "Roughness"), **self._normal(source)}

    def _glossy(self, source):
        if not is_zero(self._read(source, "Anisotropy")):
            self._report("anisotropy is not taken over")
        return {"base_color": self._color(source, "Color"), "metallic": ONE,
                "roughness": self._read(source, "Roughness"), **self._normal(source)}

    def _metallic(self, source):
        if source.node.fresnel_type != "F82":
            self._report("Metallic BSDF: a physical conductor has the colours of its F82 inputs")
        return {"base_color": self._color(source, "Base Color"), "metallic": ONE,
                "specular_color": self._color(source, "Edge Tint"),
                "roughness": self._read(source, "Roughness"), **self._normal(source)}

    def _glass(self, source):
        return {"transmission_weight": ONE, "transmission_color": self._color(source, "Color"),
                "roughness": self._read(source, "Roughness"),
                "ior": make_constant(max(self._number(source, "IOR", 1.5), 1.0)), **self._normal(source)}

    def _emission(self, source):
        keys = {"base_color": BLACK, "ior": ONE}
        emission = values.multiply(self._color(source, "Color"), self._read(source, "Strength", 1), self._values.texels)
        return {**keys, "emission": emission}

    def _transparent(self, source):
        color = self._color(source, "Color")
        if not isinstance(color, Constant) or np.any(color.rgb != 1):
            self._report("the colour of Transparent BSDF is not taken over")
        return {"base_color": BLACK, "ior": ONE, "opacity": BLACK}

    # Sums

    def _branches(self, source):
        shaders = [socket for socket in source.node.inputs if socket.type == "SHADER"]
        wires = [source.input(socket.identifier) for socket in shaders]
        return wires, [getattr(follow(wire).node, "bl_idname", "") for wire in wires]

    def _add(self, source):
        wires, kinds = self._branches(source)
        present = [wire for wire, kind in zip(wires, kinds) if kind]
        if len(present) < 2:
            return self.surface(present[0] if present else wires[0])
        a, b = (self.surface(wire) for wire in wires)
        if "ShaderNodeEmission" not in kinds:
            self._report("the second shader of Add Shader is not taken over")
            return a
        first, second = (b, a) if kinds[0] == "ShaderNodeEmission" else (a, b)
        emission = second["emission"]
        if "emission" in first:
            emission = values.combine(np.add, [first["emission"], emission], self._values.texels)
        return {**first, "emission": emission}

    def _mix(self, source):
        factor = self._read(source, "Fac", 0.5)
        wires, kinds = self._branches(source)
        if isinstance(factor, Constant) and factor.number in (0.0, 1.0):
            return self.surface(wires[int(factor.number)])
        if kinds[0] == "ShaderNodeBsdfTransparent":
            return self._cut_out(self.surface(wires[1]), factor)
        if kinds[1] == "ShaderNodeBsdfTransparent":
            return self._cut_out(self.surface(wires[0]), self._invert(factor))
        a, b = (self.surface(wire) for wire in wires)
        return self._blend(a, b, factor)

    def _invert(self, value):
        return values.combine(lambda v: 1 - v, [value], self._values.texels)

    def _cut_out(self, keys, factor):
        opacity = values.multiply(keys.get("opacity", ONE), factor, self._values.texels)
        return {**keys, "opacity": opacity}

    def _blend(self, a, b, factor):
        """A mix of two: by inputs, where both are the same but for numbers and colours, or diffuse and metal."""
        defaults = {"metallic": BLACK, "ior": make_constant(1.5), "roughness": make_constant(0.5), "emission": BLACK}
        layers = {key for key in {*a, *b} if a.get(key) is not b.get(key)}
        names = layers - {"normal"}
        is_metal = [isinstance(k.get("metallic", BLACK), Constant) and k.get("metallic", BLACK).number == 1 for k in (a, b)]
        is_plain = [set(k) <= {"base_color", "ior", "base_diffuse_roughness", "normal", "roughness", "metallic"}
                    for k in (a, b)]
        self._report("Mix Shader is a mix of the inputs of both shaders")
        result = dict(a)
        if all(is_plain) and is_metal[0] != is_metal[1]:
            names.discard("roughness")
            metal, other = (a, b) if is_metal[0] else (b, a)
            result["roughness"] = metal.get("roughness", defaults["roughness"])
            result["ior"] = other.get("ior", defaults["ior"])
            names.discard("ior")
        for name in sorted(names):
            default = defaults.get(name, ONE if name.endswith("color") or name == "opacity" else BLACK)
            result[name] = self._mix_values(a.get(name, default), b.get(name, default), factor)
        return result

    def _mix_values(self, a, b, factor):
        try:
            return values.combine(lambda f, x, y: x + f * (y - x), [factor, a, b], self._values.texels)
        except NotExpressible as fault:
            self._report(f"Mix Shader: {fault}")
            return a
