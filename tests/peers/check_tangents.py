"""The tangents of Relief against those of Blender (Mesh.calc_tangents) on meshes that Blender makes.

usage: check_tangents.py DUMP_TANGENTS"""
import math
import pathlib
import subprocess
import sys
import tempfile

import bpy  # before bmesh, which is a part of it
import bmesh

LARGEST_ANGLE = 0.02  # degrees; both are sums of floats


def add_monkey():
    bpy.ops.mesh.primitive_monkey_add(calc_uvs=True)


def add_sphere():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, calc_uvs=True)


def add_torus():
    bpy.ops.mesh.primitive_torus_add(generate_uvs=True)


def add_mirrored_grid():
    """Halves whose uvs are turned against each other, as artists mirror what they unwrap."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, calc_uvs=True)
    mesh = bpy.context.object.data
    for vertex in mesh.vertices:
        vertex.co.z = 0.3 * math.sin(3 * vertex.co.x) * math.cos(2 * vertex.co.y)
    for uv in mesh.uv_layers.active.data:
        uv.uv = (abs(uv.uv[0] - 0.5), uv.uv[1] + 0.1 * uv.uv[0] * uv.uv[0])


def triangulate_half(mesh):
    edited = bmesh.new()
    edited.from_mesh(mesh)
    faces = [face for face in edited.faces if face.index % 2 == 0]
    bmesh.ops.triangulate(edited, faces=faces)
    edited.to_mesh(mesh)
    edited.free()


def get_normals(mesh):
    return [corner.vector.copy() for corner in mesh.corner_normals]


def write_obj(mesh, file):
    """Every corner with a uv and a normal of its own, in the order of the corners, with all digits."""
    uvs, normals = mesh.uv_layers.active.data, get_normals(mesh)
    with open(file, "w", encoding="ascii") as out:
        for vertex in mesh.vertices:
            out.write("v {:.9g} {:.9g} {:.9g}\n".format(*vertex.co))
        for uv, normal in zip(uvs, normals):
            out.write("vt {:.9g} {:.9g}\n".format(*uv.uv))
            out.write("vn {:.9g} {:.9g} {:.9g}\n".format(*normal))
        for polygon in mesh.polygons:
            corners = (f"{mesh.loops[k].vertex_index + 1}/{k + 1}/{k + 1}" for k in polygon.loop_indices)
            out.write("f " + " ".join(corners) + "\n")


def find_angle(a, b):
    cross = math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return math.degrees(math.atan2(cross, sum(x * y for x, y in zip(a, b))))


def compare(name, mesh, dump, folder):
    """Prints the largest angle; returns whether all corners agree."""
    file = folder / (name + ".obj")
    write_obj(mesh, file)
    found = subprocess.run([dump, file], check=True, capture_output=True, text=True).stdout.splitlines()
    mesh.calc_tangents(uvmap=mesh.uv_layers.active.name)
    corners = len(mesh.loops)
    largest, turned = 0.0, 0
    for line, loop in zip(found, mesh.loops):
        *tangent, sign = map(float, line.split())
        largest = max(largest, find_angle(tangent, loop.tangent))
        turned += sign != loop.bitangent_sign
    print(f"{name}: {corners} corners, largest angle {largest:.5f} degrees, {turned} of the other sign")
    return corners > 0 and len(found) == corners and largest <= LARGEST_ANGLE and turned == 0


def main():
    dump = sys.argv[1]
    agree = True
    with tempfile.TemporaryDirectory() as folder:
        for add in (add_monkey, add_sphere, add_torus, add_mirrored_grid):
            for is_mixed in (False, True):
                bpy.ops.wm.read_factory_settings(use_empty=True)
                add()
                mesh = bpy.context.object.data
                mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
                if is_mixed:
                    triangulate_half(mesh)
                name = add.__name__.removeprefix("add_") + ("_mixed" if is_mixed else "")
                agree = compare(name, mesh, dump, pathlib.Path(folder)) and agree
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())
