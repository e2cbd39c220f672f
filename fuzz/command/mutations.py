"""Changes of files: of bytes, of words of a text, and behind checksums and parsers (PNG, JSON, GLB)."""
import json
import re
import struct
import zlib

import seeds

NUMBERS = [0, -0.0, 1, -1, 2, 3, 255, 256, 65535, 65536, 2 ** 31 - 1, 2 ** 31, 2 ** 32 - 1, 2 ** 32, 2 ** 63, -2 ** 31, 1e-30,
           1e30, 1e300, 0.1, -0.5, 1.5, 10, 20, 21, 22]
DEEP = "nested arrays"  # stands for them until the document is text
WORD = re.compile(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?|[A-Za-z_]\w*")


def change_bytes(data, random):
    data = bytearray(data)
    for _ in range(random.choice((1, 1, 1, 2, 4, 16))):
        if not data:
            break
        at, count = random.randrange(len(data)), random.choice((1, 2, 4, 8, 64))
        kind = random.randrange(7)
        if kind == 0:
            data[at] ^= 1 << random.randrange(8)
        elif kind == 1:
            data[at] = random.choice((0, 1, 127, 128, 255, random.randrange(256)))
        elif kind == 2:
            word = struct.pack(random.choice("<>") + "I", random.choice((0, 1, 2 ** 16, 2 ** 31 - 1, 2 ** 31, 2 ** 32 - 1)))
            data[at:at + 4] = word
        elif kind == 3:
            del data[at:at + count]
        elif kind == 4:
            data[at:at] = data[at:at + count]
        elif kind == 5:
            data[at:at] = random.randbytes(count)
        else:
            del data[at:]
    return bytes(data)


def change_words(data, random):
    """Numbers and names of a text become others, of a list or from elsewhere in the text; lines move."""
    for _ in range(random.choice((1, 1, 2, 4, 8))):
        words = list(WORD.finditer(data))
        if not words:
            return data
        word = random.choice(words)
        if random.random() < 0.7:
            other = (random.choice(words).group() if random.random() < 0.5
                     else repr(random.choice(NUMBERS)).encode())
            if random.random() < 0.02:
                other = random.choice((b"nan", b"inf", b"9" * 400, b"1e999"))
            data = data[:word.start()] + other + data[word.end():]
            continue
        lines = data.split(b"\n")
        at = random.randrange(len(lines))
        kind = random.randrange(4)
        if kind == 0:
            del lines[at]
        elif kind == 1:
            lines[at:at] = [lines[at]] * random.choice((1, 2, 100))
        elif kind == 2:
            other = random.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        else:
            del lines[at:]
        data = b"\n".join(lines)
    return data


def list_places(value, places):
    """All (container, key) of a JSON document."""
    for key, child in (value.items() if isinstance(value, dict) else enumerate(value)):
        places.append((value, key))
        if isinstance(child, (dict, list)):
            list_places(child, places)
    return places


def change_json(text, random):
    """The text of the document with some values changed; it still parses."""
    document = json.loads(text)
    for _ in range(random.choice((1, 1, 2, 4))):
        places = list_places(document, [])
        if not places:
            break
        # Other numbers in the place of numbers get farther than other types do.
        numbers = [(c, k) for c, k in places if isinstance(c[k], (int, float))]
        if numbers and random.random() < 0.6:
            container, key = random.choice(numbers)
            container[key] = random.choice(NUMBERS + [c[k] for c, k in numbers])
            continue
        container, key = random.choice(places)
        other_container, other_key = random.choice(places)
        kind = random.randrange(8)
        if kind == 0:
            del container[key]
        elif kind == 1:
            container[key] = json.loads(json.dumps(other_container[other_key]))
        elif kind == 2:
            container[key] = random.choice(([], {}, "", "good.obj", None, True, "\u00e9" * 300, [[[]]], "../good.png"))
        elif kind == 3 and isinstance(container, list):
            container[key:key] = [container[key]] * random.choice((1, 3, 1000))
        elif kind == 4:
            container[key] = DEEP
        else:
            container[key] = random.choice(NUMBERS)
    depth = random.choice((1, 3, 2000))
    return json.dumps(document).replace(json.dumps(DEEP), "[" * depth + "]" * depth).encode()


def change_fbx(data, random):
    """Of a text also the graph of its objects: connections among numbers that stand in the file already."""
    start = data.find(b"Connections:")
    if start < 0 or random.random() < 0.5:
        return change_words(data, random)
    lines = data[start:].split(b"\n")
    numbers = [b"0", b"10", b"20", b"21", b"22"]
    for _ in range(random.choice((1, 2, 4))):
        line = b"\tC: \"OO\"," + random.choice(numbers) + b"," + random.choice(numbers)
        at = random.randrange(1, len(lines) - 2)
        if random.random() < 0.5:
            lines[at] = line
        else:
            lines.insert(at, line)
    return data[:start] + b"\n".join(lines)


def change_glb(data, random):
    text, buffer = seeds.unpack_glb(data)
    if random.random() < 0.25:
        return seeds.pack_glb(text, change_bytes(buffer, random))
    return seeds.pack_glb(change_json(text, random), buffer)


def change_png(data, random):
    """Payloads of chunks, the compressed pixels among them, with checksums that are right again."""
    chunks, at = [], 8
    while at < len(data):
        size = struct.unpack_from(">I", data, at)[0]
        chunks.append((data[at + 4:at + 8], data[at + 8:at + 8 + size]))
        at += 12 + size
    for _ in range(random.choice((1, 1, 2))):
        if not chunks:
            break
        place = random.randrange(len(chunks))
        kind, payload = chunks[place]
        choice = random.randrange(6)
        if choice == 0:
            chunks.insert(random.randrange(len(chunks)), (kind, payload))
        elif choice == 1:
            del chunks[place]
        elif choice == 2:
            chunks[place] = (bytes(random.choice(b"abcdIDATEPLNtRSz") for _ in range(4)), payload)
        elif kind == b"IDAT" and choice < 5:
            try:
                payload = zlib.decompress(payload)
            except zlib.error:
                pass
            chunks[place] = (kind, zlib.compress(change_bytes(payload, random)))
        else:
            chunks[place] = (kind, change_bytes(payload, random))
    return data[:8] + b"".join(seeds.pack_png_chunk(*chunk) for chunk in chunks)


STRUCTURED = {".png": change_png, ".glb": change_glb, ".gltf": change_json, ".json": change_json, ".obj": change_words,
              ".ply": change_words, ".fbx": change_fbx, ".hdr": change_words}


def mutate(suffix, data, random):
    """A changed copy; most changes keep to the structure of the format."""
    change = STRUCTURED.get(suffix, change_bytes)
    is_binary = b"\0" in data[:2000] and suffix in (".fbx", ".ply", ".hdr")
    if is_binary or random.random() < 0.3:
        change = change_bytes
    return change(data, random)
