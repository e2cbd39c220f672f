"""Whether an EXR file is of the plain kind that Relief reads without further libraries."""
import struct

MAGIC = 20000630
NOT_PLAIN = 0x800 | 0x1000  # deep pixels, several parts
HALF, FLOAT = 1, 2


def read_text(stream):
    """A text that ends with a zero byte."""
    text = bytearray()
    while (byte := stream.read(1)) not in (b"", b"\0"):
        text += byte
    return text.decode("latin-1")


def read_channels(data):
    """{name: (type, x sampling, y sampling)} of a list of channels."""
    channels, at = {}, 0
    while at < len(data) and data[at] != 0:
        end = data.index(b"\0", at)
        kind, _, x, y = struct.unpack_from("<iIii", data, end + 1)
        channels[data[at:end].decode("latin-1")] = (kind, x, y)
        at = end + 17
    return channels


def is_plain_exr(path):
    """One part of flat pixels, with channels of one type, half or float, of the names R G B A or Y."""
    try:
        with open(path, "rb") as stream:
            magic, version = struct.unpack("<iI", stream.read(8))
            if magic != MAGIC or version & NOT_PLAIN:
                return False
            while name := read_text(stream):
                kind = read_text(stream)
                data = stream.read(struct.unpack("<i", stream.read(4))[0])
                if name == "channels" and kind == "chlist":
                    channels = read_channels(data)
                    types = {value for value in channels.values()}
                    return types in ({(HALF, 1, 1)}, {(FLOAT, 1, 1)}) and (
                        set(channels) <= set("RGBA") and {"R", "G", "B"} <= set(channels) or set(channels) == {"Y"})
    except (OSError, struct.error, ValueError):
        pass
    return False
