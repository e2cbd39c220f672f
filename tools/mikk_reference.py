"""Blender's tangents of a small mesh, as the constants of tests/surface/mikk_reference.h.

    blender -b --python tools/mikk_reference.py -- tests/surface/mikk_reference.h
    blender -b --python tools/mikk_reference.py -- MESH.obj OUT.txt

The second form takes any mesh of triangles and quads and writes a line a corner: its normal, tangent and sign,
each number as the bits of a float.
"""
import math
import random
import struct
import sys

import bpy

COLUMNS, ROWS = 2, 3


def add_shell(vertices, faces, uvs, sign):
    """A bent sheet; that of sign -1 is its mirror image at x = 0, with the same uvs."""
    random.seed(7)
    first = len(vertices)
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            x, y = 0.3 * i + (0.08 * random.random() if i else 0), 0.3 * j + 0.08 * random.random()
            vertices.append((sign * x, y, 0.5 * math.sin(2 * x) * math.cos(1.5 * y) + 0.05 * random.random()))
    texture = [(i / COLUMNS + 0.05 * random.random(), 0.8 * j / ROWS + 0.05 * random.random())
               for j in range(ROWS + 1) for i in range(COLUMNS + 1)]
    for j in range(ROWS):
        for i in range(COLUMNS):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            if sign < 0:
                corners.reverse()
            turn = random.randrange(4)
            corners = corners[turn:] + corners[:turn]
            numbers = [b * (COLUMNS + 1) + a for a, b in corners]
            faces.append([first + n for n in numbers])
            # Upper rows lie elsewhere on the map, turned: a seam.
            uvs.append([(1.2 - texture[n][1], texture[n][0]) if j >= 2 else texture[n] for n in numbers])


def make_mesh():
    vertices, faces, uvs = [], [], []
    add_shell(vertices, faces, uvs, 1)
    add_shell(vertices, faces, uvs, -1)
    # The two shells share the points of x = 0; a fan of triangles makes one of valence five and more.
    places = {}
    joined = [places.setdefault(v, n) for n, v in enumerate(vertices)]
    faces = [[joined[n] for n in face] for face in faces]
    tip = len(vertices)
    vertices.append((0.1, -0.35, 0.2))
    for i in range(2):
        face = [i + 1, i, tip]
        faces.append(face)
        uvs.append([(0.1 + 0.3 * (i + 1), 0.9), (0.1 + 0.3 * i, 0.93), (0.4, 0.99)])
    used = sorted({n for face in faces for n in face})
    number = {n: k for k, n in enumerate(used)}
    return build_mesh([vertices[n] for n in used], [[number[n] for n in face] for face in faces], uvs)


def build_mesh(vertices, faces, uvs):
    mesh = bpy.data.meshes.new("reference")
    mesh.from_pydata(vertices, [], faces)
    layer = mesh.uv_layers.new(name="uv")
    for polygon, corners in zip(mesh.polygons, uvs):
        for loop, uv in zip(polygon.loop_indices, corners):
            layer.data[loop].uv = uv
    return mesh


def read_mesh(file):
    """Faces and their corners stay in the order of the file."""
    vertices, texture, faces, uvs = [], [], [], []
    for line in open(file):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(w) for w in words[1:4]])
        elif words[:1] == ["vt"]:
            texture.append([float(w) for w in words[1:3]])
        elif words[:1] == ["f"]:
            corners = [word.split("/") for word in words[1:]]
            faces.append([int(c[0]) - 1 for c in corners])
            uvs.append([texture[int(c[1]) - 1] for c in corners])
    return build_mesh(vertices, faces, uvs)


def add_tangents(mesh):
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    mesh.use_auto_smooth = False
    mesh.calc_tangents(uvmap=mesh.uv_layers[0].name)


def join_numbers(numbers):
    numbers = [n + 0.0 for n in numbers]  # -0 becomes 0
    return ", ".join("%.9gf" % n if "." in "%.9g" % n or "e" in "%.9g" % n else "%.9g" % n for n in numbers)


def write_list(out, declaration, items):
    out.write("inline constexpr %s = {" % declaration)
    width = 1000
    for item in items:
        width += len(item) + 2
        if width > 110:
            out.write("\n   ")
            width = len(item) + 5
        out.write(" " + item + ",")
    out.write("\n};\n")


def write_header(mesh, file):
    uvs = mesh.uv_layers[0].data
    with open(file, "w") as out:
        out.write("// Tangents of a bent mesh with a mirrored shell, a seam and irregular points, by Blender %s\n"
                  "// (tools/mikk_reference.py).\n#pragma once\n\nnamespace relief::test {\n\n"
                  % bpy.app.version_string)
        out.write("// clang-format off\n")
        write_list(out, "float kMikkPositions[][3]", ["{%s}" % join_numbers(v.co) for v in mesh.vertices])
        write_list(out, "unsigned kMikkFaceSizes[]", [str(len(p.vertices)) for p in mesh.polygons])
        out.write("\n/// One a corner: point, uv, normal, tangent, sign of the bitangent.\n"
                  "struct MikkCorner {\n    unsigned point;\n    float uv[2], normal[3], tangent[3], sign;\n};\n")
        write_list(out, "MikkCorner kMikkCorners[]",
                   ["{%d, {%s}, {%s}, {%s}, %d}" % (loop.vertex_index, join_numbers(uvs[loop.index].uv),
                                                    join_numbers(loop.normal), join_numbers(loop.tangent),
                                                    loop.bitangent_sign) for loop in mesh.loops])
        out.write("// clang-format on\n\n} // namespace relief::test\n")


def write_corners(mesh, file):
    with open(file, "w") as out:
        for loop in mesh.loops:
            values = (*loop.normal, *loop.tangent, loop.bitangent_sign)
            out.write(" ".join("%08x" % struct.unpack("<I", struct.pack("<f", v))[0] for v in values) + "\n")


arguments = sys.argv[sys.argv.index("--") + 1:]
reference = make_mesh() if len(arguments) == 1 else read_mesh(arguments[0])
add_tangents(reference)
if len(arguments) == 1:
    write_header(reference, arguments[0])
else:
    write_corners(reference, arguments[1])
