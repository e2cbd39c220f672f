"""Small valid files of each format that the command reads, written here or by the command itself."""
import json
import math
import struct
import subprocess
import zlib

SIDE = 8  # quads a side of the mesh, and half of the texels a side of the map


def make_grid():
    """Points, uvs and quads of a curved sheet."""
    points, uvs, faces = [], [], []
    for j in range(SIDE + 1):
        for i in range(SIDE + 1):
            u, v = i / SIDE, j / SIDE
            points.append((2 * u - 1, 2 * v - 1, 0.25 * math.sin(3 * u) * v))
            uvs.append((u, v))
    for j in range(SIDE):
        for i in range(SIDE):
            first = j * (SIDE + 1) + i
            faces.append((first, first + 1, first + SIDE + 2, first + SIDE + 1))
    return points, uvs, faces


def make_texels(size, largest):
    """Rows of (r, g, b) between 0 and `largest`: a bump along the last channel, on a middle value."""
    middle = largest // 2
    rows = []
    for y in range(size):
        row = []
        for x in range(size):
            bump = max(0, 1 - 4 * ((x / size - 0.5) ** 2 + (y / size - 0.5) ** 2))
            row.append((middle + int(0.1 * bump * largest), middle, middle + int(0.4 * bump * largest)))
        rows.append(row)
    return rows


def make_obj():
    points, uvs, faces = make_grid()
    lines = ["v {:.5f} {:.5f} {:.5f}".format(*p) for p in points]
    lines += ["vt {:.5f} {:.5f}".format(*uv) for uv in uvs]
    lines += ["f " + " ".join(f"{k + 1}/{k + 1}" for k in face) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def make_ascii_ply():
    points, uvs, faces = make_grid()
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    header += [f"property float {name}" for name in ("x", "y", "z", "s", "t")]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    body = [" ".join(f"{value:.5f}" for value in (*p, *uv)) for p, uv in zip(points, uvs)]
    body += ["4 " + " ".join(map(str, face)) for face in faces]
    return ("\n".join(header + body) + "\n").encode()


def make_gltf():
    """The document and its buffer."""
    points, uvs, faces = make_grid()
    triangles = [k for a, b, c, d in faces for k in (a, b, c, a, c, d)]
    parts = [struct.pack(f"<{3 * len(points)}f", *(x for p in points for x in p)),
             struct.pack(f"<{2 * len(uvs)}f", *(x for uv in uvs for x in uv)),
             struct.pack(f"<{len(triangles)}I", *triangles)]
    views, at = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(part)})
        at += len(part)
    accessors = [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"},
                 {"bufferView": 1, "componentType": 5126, "count": len(uvs), "type": "VEC2"},
                 {"bufferView": 2, "componentType": 5125, "count": len(triangles), "type": "SCALAR"}]
    primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"children": [1], "translation": [0, 0, 1]},
                          {"mesh": 0, "rotation": [0, 0, 0, 1], "scale": [1, 2, 1]}],
                "meshes": [{"primitives": [primitive]}], "buffers": [{"byteLength": at}],
                "bufferViews": views, "accessors": accessors}
    return document, b"".join(parts)


def pack_glb(text, buffer):
    text += b" " * (-len(text) % 4)
    length = 28 + len(text) + len(buffer)
    return (struct.pack("<4sII", b"glTF", 2, length) + struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(buffer), b"BIN\0") + buffer)


def unpack_glb(data):
    """Text and buffer of a file that pack_glb made."""
    size = struct.unpack_from("<I", data, 12)[0]
    return data[20:20 + size], data[28 + size:]


def make_glb():
    document, buffer = make_gltf()
    return pack_glb(json.dumps(document).encode(), buffer)


def make_ascii_fbx():
    points, uvs, faces = make_grid()

    def array(name, values):
        return f"\t\t{name}: *{len(values)} {{\n\t\t\ta: {','.join(map(str, values))}\n\t\t}}\n"
    corners = [k for a, b, c, d in faces for k in (a, b, c, -d - 1)]
    text = ("; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n"
            "Objects:  {\n\tGeometry: 10, \"Geometry::g\", \"Mesh\" {\n")
    text += array("Vertices", [round(x, 5) for p in points for x in p])
    text += array("PolygonVertexIndex", corners)
    text += ("\t\tLayerElementUV: 0 {\n\t\tVersion: 101\n\t\tName: \"map1\"\n"
             "\t\tMappingInformationType: \"ByPolygonVertex\"\n\t\tReferenceInformationType: \"IndexToDirect\"\n")
    text += array("UV", [round(x, 5) for uv in uvs for x in uv]) + array("UVIndex", [k for f in faces for k in f])
    text += ("\t\t}\n\t\tLayer: 0 {\n\t\tVersion: 100\n\t\tLayerElement:  {\n\t\tType: \"LayerElementUV\"\n"
             "\t\tTypedIndex: 0\n\t\t}\n\t\t}\n\t}\n")
    for number, name in ((20, "root"), (21, "arm"), (22, "hand")):
        text += f"\tModel: {number}, \"Model::{name}\", \"Mesh\" {{\n\t\tVersion: 232\n\t}}\n"
    text += "}\nConnections:  {\n"
    for child, parent in ((20, 0), (21, 20), (22, 21), (10, 22)):
        text += f"\tC: \"OO\",{child},{parent}\n"
    return (text + "}\n").encode()


def pack_fbx_property(value):
    """A string, an integer of 64 bits, one of 32 bits as a tuple, or a list as a compressed array."""
    if isinstance(value, str):
        return struct.pack("<cI", b"S", len(value)) + value.encode()
    if isinstance(value, int):
        return struct.pack("<cq", b"L", value)
    if isinstance(value, tuple):
        return struct.pack("<ci", b"I", *value)
    kind, code = ("i", b"i") if isinstance(value[0], int) else ("d", b"d")
    data = struct.pack(f"<{len(value)}{kind}", *value)
    packed = zlib.compress(data)
    return struct.pack("<cIII", code, len(value), 1, len(packed)) + packed


def pack_fbx_node(at, name, values, children):
    """The record of a node that begins at byte `at`."""
    properties = b"".join(map(pack_fbx_property, values))
    body = struct.pack("B", len(name)) + name.encode() + properties
    end = at + 12 + len(body)
    for child in children:
        record = pack_fbx_node(end, *child)
        body += record
        end += len(record)
    if children:
        body += bytes(13)
        end += 13
    return struct.pack("<III", end, len(values), len(properties)) + body


def make_binary_fbx():
    points, _, faces = make_grid()
    corners = [k for a, b, c, d in faces for k in (a, b, c, -d - 1)]
    geometry = [("Vertices", [[x for p in points for x in p]], []), ("PolygonVertexIndex", [corners], [])]
    nodes = [("FBXHeaderExtension", [], [("FBXVersion", [(7400,)], [])]),
             ("Objects", [], [("Geometry", [10, "g\0\1Geometry", "Mesh"], geometry),
                              ("Model", [20, "a\0\1Model", "Mesh"], [("Version", [(232,)], [])]),
                              ("Model", [21, "b\0\1Model", "Null"], [("Version", [(232,)], [])])]),
             ("Connections", [], [("C", ["OO", 21, 0], []), ("C", ["OO", 20, 21], []), ("C", ["OO", 10, 20], [])])]
    data = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400)
    for node in nodes:
        data += pack_fbx_node(len(data), *node)
    return data + bytes(13)


def pack_png_chunk(kind, payload):
    return struct.pack(">I", len(payload)) + kind + payload + struct.pack(">I", zlib.crc32(kind + payload))


def make_png():
    rows = make_texels(2 * SIDE, 65535)
    scanlines = b"".join(b"\0" + struct.pack(f">{6 * SIDE}H", *(c for texel in row for c in texel)) for row in rows)
    header = struct.pack(">IIBBBBB", 2 * SIDE, 2 * SIDE, 16, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + pack_png_chunk(b"IHDR", header) + pack_png_chunk(b"gAMA", struct.pack(">I", 100000)) +
            pack_png_chunk(b"tEXt", b"Title\0bump") + pack_png_chunk(b"IDAT", zlib.compress(scanlines)) +
            pack_png_chunk(b"IEND", b""))


def make_tiff():
    size = 2 * SIDE
    pixels = b"".join(struct.pack("<3H", *texel) for row in make_texels(size, 65535) for texel in row)
    extra = 8 + len(pixels)  # the three sample sizes lie behind the pixels
    entries = [(256, 3, 1, size), (257, 3, 1, size), (258, 3, 3, extra), (259, 3, 1, 1), (262, 3, 1, 2), (273, 4, 1, 8),
               (277, 3, 1, 3), (278, 3, 1, size), (279, 4, 1, len(pixels)), (284, 3, 1, 1)]
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *entry) for entry in entries) + bytes(4)
    return struct.pack("<2sHI", b"II", 42, extra + 6) + pixels + struct.pack("<3H", 16, 16, 16) + directory


def make_hdr():
    """Coded by runs, one literal run a channel and row."""
    width, height = 2 * SIDE, SIDE
    data = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    for y in range(height):
        data += struct.pack(">BBH", 2, 2, width)
        for channel in range(4):
            data += bytes([width]) + bytes(128 if channel == 3 else (40 + 20 * y + x) % 256 for x in range(width))
    return data


def make_scene():
    return json.dumps({
        "version": 1, "render": {"width": 16, "height": 12, "spp": 1, "bounces": 1},
        "camera": {"from": [0, 1, 4], "to": [0, 0, 0], "fov_degrees": 40},
        "environment": {"color": [0.5, 0.6, 0.7], "strength": 1},
        "lights": [{"type": "sun", "direction": [0, -1, -1], "strength": 2}],
        "materials": {"clay": {"base_color": [0.8, 0.5, 0.4], "roughness": 0.6}},
        "displacements": {"bump": {"file": "good.png", "space": "tangent", "midlevel": 0.5, "scale": 0.5}},
        "meshes": {"sheet": {"file": "good.obj", "subdivision": {"scheme": "catmark", "level": 1}}},
        "objects": [{"name": "a", "mesh": "sheet", "displacement": "bump", "material": "clay",
                     "transform": {"translate": [1, 0, 0]}}, {"mesh": "sheet"}]}, indent=1).encode()


def make_seeds(program, folder):
    """Writes good.obj and good.png into `folder` for the others to stand beside; returns {suffix: [bytes]}."""
    document, buffer = make_gltf()
    (folder / "good.bin").write_bytes(buffer)
    document["buffers"][0]["uri"] = "good.bin"
    seeds = {".obj": [make_obj()], ".ply": [make_ascii_ply()], ".gltf": [json.dumps(document).encode()],
             ".glb": [make_glb()], ".fbx": [make_ascii_fbx(), make_binary_fbx()], ".png": [make_png()],
             ".tif": [make_tiff()], ".hdr": [make_hdr()], ".json": [make_scene()], ".exr": []}
    (folder / "good.obj").write_bytes(seeds[".obj"][0])
    (folder / "good.png").write_bytes(seeds[".png"][0])

    def convert(name, *words):
        subprocess.run([program, "convert", *words, "-o", name], cwd=folder, check=True, capture_output=True)
        return (folder / name).read_bytes()
    seeds[".ply"].append(convert("binary.ply", "good.obj"))
    for samples in ("half", "float"):
        seeds[".exr"].append(convert(f"{samples}.exr", "good.png", "--space", "tangent", "--samples", samples))
    return seeds
