"""Pictures of materials beside those of Mitsuba 3, on a sphere and on the tessellated surface of a sample scene.

usage: check_materials.py RELIEF

Means agree within 1 % where both mean the same by a material. Where they do not the reason is said, and the bound is that
of the difference."""
import json
import pathlib
import subprocess
import sys
import tempfile

import mitsuba
import numpy

RELIEF = sys.argv[1]
SIZE, SPP, BOUNCES = 48, 256, 60
GREY = [0.6, 0.3, 0.1]

mitsuba.set_variant("scalar_rgb")


def principled(**inputs):
    return {"type": "principled", **{name: rgb(v) if isinstance(v, list) else v for name, v in inputs.items()}}


def rgb(color):
    return {"type": "rgb", "value": color}


def ggx(kind, roughness, **inputs):
    return {"type": kind, "distribution": "ggx", "alpha": roughness * roughness, **inputs}


def two_sided(bsdf):
    """The rock has folds that are seen from within, where an opaque BSDF of Mitsuba is black."""
    return {"type": "twosided", "bsdf": bsdf}


def make_metal(roughness):
    """An ideal mirror in its reflectance, without Fresnel's rise at grazing angles."""
    return two_sided(ggx("roughconductor", roughness, material="none", specular_reflectance=rgb([0.9, 0.9, 0.9])))


def make_brushed(roughness, anisotropy, is_turned=False):
    """OpenPBR's widths of the facets along u and v."""
    along = roughness ** 2 * (2 / (1 + (1 - anisotropy) ** 2)) ** 0.5
    u, v = (along, along * (1 - anisotropy)) if not is_turned else (along * (1 - anisotropy), along)
    return two_sided({"type": "roughconductor", "distribution": "ggx", "alpha_u": u, "alpha_v": v, "material": "none",
                      "specular_reflectance": rgb([0.9, 0.9, 0.9])})


PLAIN = {"base_color": [0.9, 0.9, 0.9], "metallic": 1, "specular_color": [1, 1, 1]}
BRUSHED = {**PLAIN, "roughness": 0.3, "specular_roughness_anisotropy": 0.8}
# Name, material of Relief, BSDF of Mitsuba, bounds of the difference on sphere and rock (None: not there, it has no uvs),
# reason where they are above 1 %.
CASES = [
    ("matte", {"base_color": GREY, "specular_weight": 0}, two_sided({"type": "diffuse", "reflectance": rgb(GREY)}), (0.01, 0.01), ""),
    ("smooth metal", {**PLAIN, "roughness": 0.1}, make_metal(0.1), (0.015, 0.025),
     "Schlick's reflection of 0.9 rises to 1 at grazing angles"),
    ("rough metal", {**PLAIN, "roughness": 0.6}, make_metal(0.6), (0.3, 0.7),
     "the same, and Mitsuba loses what facets reflect several times"),
    ("brushed metal", BRUSHED, make_brushed(0.3, 0.8), (0.03, None), "as of smooth metal"),
    ("glass", {"transmission_weight": 1, "roughness": 0.3, "ior": 1.5}, ggx("roughdielectric", 0.3, int_ior=1.5), (0.01, 0.01), ""),
    ("thin glass", {"transmission_weight": 1, "roughness": 0, "ior": 1.5, "geometry_thin_walled": True},
     {"type": "thindielectric", "int_ior": 1.5}, (0.01, 0.01), ""),
    ("plastic", {"base_color": GREY, "roughness": 0.4, "ior": 1.5}, principled(base_color=GREY, roughness=0.4, eta=1.5), (0.1, 0.1),
     "Disney's diffuse lobe is brighter at grazing angles, and its specular lobe is added to it"),
]


def write_sphere(file):
    """Radius 1, latitudes and longitudes; u goes around."""
    rows, columns = 96, 192
    lines = [f"vt {j / columns:.7f} {1 - i / rows:.7f}" for i in range(rows + 1) for j in range(columns + 1)]
    for i in range(rows + 1):
        for j in range(columns):
            polar, turn = numpy.pi * i / rows, 2 * numpy.pi * j / columns
            lines.append(f"v {numpy.sin(polar) * numpy.cos(turn):.7f} {numpy.cos(polar):.7f} "
                         f"{-numpy.sin(polar) * numpy.sin(turn):.7f}")
    for i in range(rows):
        for j in range(columns):
            def corner(row, column):
                return f"{row * columns + column % columns + 1}/{row * (columns + 1) + column + 1}"

            if i < rows - 1:
                lines.append(f"f {corner(i, j)} {corner(i + 1, j)} {corner(i + 1, j + 1)}")
            if i > 0:
                lines.append(f"f {corner(i, j)} {corner(i + 1, j + 1)} {corner(i, j + 1)}")
    file.write_text("\n".join(lines) + "\n")


def write_rock(folder, file):
    """The displaced surface of the sample scene, within the unit sphere."""
    subprocess.run([RELIEF, "scene", "rock", "-o", folder / "rock", "-q"], check=True)
    tessellated = folder / "rock" / "tessellated.obj"
    subprocess.run([RELIEF, "convert", folder / "rock" / "scene.json", "-o", tessellated, "--level", "4", "-q"], check=True)
    rows = [line.split() for line in tessellated.read_text().splitlines()]
    points = numpy.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    points -= (points.min(axis=0) + points.max(axis=0)) / 2
    points /= numpy.linalg.norm(points, axis=1).max()
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in points]
    for row in rows:
        corners = [corner.split("/")[0] for corner in row[1:]]
        if row[:1] == ["f"]:  # in triangles, so that both cut alike
            lines += [f"f {corners[0]} {b} {c}" for b, c in zip(corners[1:], corners[2:])]
    file.write_text("\n".join(lines) + "\n")


def write_light(file):
    """A square that faces the origin from above, to the right."""
    file.write_text("v 3 3 0\nv 3 3 2\nv 2 4 2\nv 2 4 0\nf 1 2 3\nf 1 3 4\n")


def render_relief(folder, mesh, camera, material):
    scene = {"version": 1, "render": {"width": SIZE, "height": SIZE, "spp": SPP, "bounces": BOUNCES}, "camera": camera,
             "environment": {"color": [0.5, 0.5, 0.6]},
             "materials": {"shown": material, "light": {"base_color": [0, 0, 0], "specular_weight": 0, "emission": [20, 18, 16]}},
             "meshes": {"body": {"file": mesh.name}, "light": {"file": "light.obj"}},
             "objects": [{"mesh": "body", "material": "shown"}, {"mesh": "light", "material": "light"}]}
    file = folder / "scene.json"
    file.write_text(json.dumps(scene))
    picture = folder / "relief.exr"
    subprocess.run([RELIEF, "render", file, "-o", picture, "--clamp-indirect", "0", "-q"], check=True)
    bitmap = mitsuba.Bitmap(str(picture))
    names = [field.name for field in bitmap.struct_()]
    values = numpy.array(bitmap)
    return values[..., [names.index(channel) for channel in "RGB"]], values[..., names.index("A")] == 1


def render_mitsuba(folder, mesh, camera, bsdf):
    transform = mitsuba.ScalarTransform4f().look_at(origin=camera["from"], target=camera["to"], up=[0, 1, 0])
    scene = mitsuba.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": BOUNCES + 2, "rr_depth": 100},
        "sensor": {"type": "perspective", "fov": camera["fov_degrees"], "to_world": transform,
                   "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}},
                   "sampler": {"type": "independent", "sample_count": SPP}},
        "sky": {"type": "constant", "radiance": rgb([0.5, 0.5, 0.6])},
        "body": {"type": mesh.suffix[1:], "filename": str(mesh), "face_normals": True, "bsdf": bsdf},
        "light": {"type": "obj", "filename": str(folder / "light.obj"), "face_normals": True,
                 "bsdf": {"type": "diffuse", "reflectance": rgb([0, 0, 0])},
                 "emitter": {"type": "area", "radiance": rgb([20, 18, 16])}}})
    return numpy.array(mitsuba.render(scene))[..., :3]


def blur(picture):
    """Means of squares of four by four pixels."""
    return picture.reshape(SIZE // 4, 4, SIZE // 4, 4, 3).mean(axis=(1, 3))


def check_streaks(folder, mesh, camera):
    """Highlights lie along u, not across it."""
    ours = blur(render_relief(folder, mesh, camera, BRUSHED)[0])
    apart = [numpy.sqrt(((ours - blur(render_mitsuba(folder, mesh, camera, make_brushed(0.3, 0.8, is_turned)))) ** 2).mean())
             for is_turned in (False, True)]
    print(f"streaks differ by {apart[0]:.4f} along u, {apart[1]:.4f} across it")
    return [] if apart[0] < 0.3 * apart[1] else ["streaks"]


def main():
    folder = pathlib.Path(tempfile.mkdtemp())
    write_sphere(folder / "sphere.obj")
    write_light(folder / "light.obj")
    write_rock(folder, folder / "rock.obj")
    camera = {"from": [0, 0.5, 4], "to": [0, 0, 0], "fov_degrees": 28}
    failed = check_streaks(folder, folder / "sphere.obj", camera)
    for place, mesh in enumerate((folder / "sphere.obj", folder / "rock.obj")):
        is_body = render_relief(folder, mesh, camera, CASES[0][1])[1]
        for name, material, bsdf, bounds, reason in CASES:
            if bounds[place] is None:
                continue
            ours = render_relief(folder, mesh, camera, material)[0][is_body].mean(axis=0)
            theirs = render_mitsuba(folder, mesh, camera, bsdf)[is_body].mean(axis=0)
            worst = abs(ours / theirs - 1).max()
            print(f"{mesh.stem:7} {name:13} Relief {ours.round(4)} Mitsuba {theirs.round(4)} difference {worst:.4f} "
                  f"bound {bounds[place]} {reason}", flush=True)
            if not worst <= bounds[place]:
                failed.append(f"{mesh.stem}, {name}")
    assert not failed, failed


if __name__ == "__main__":
    main()
