// Whether a JPEG stream is whole.
#pragma once

#include <istream>
#include <streambuf>

namespace relief {

/// Whether a JPEG stream gets to the marker that ends its picture: the decoder makes up the rest of a file
/// that is cut before it, without an error. Among coded samples a byte ff is followed by 00 or a restart
/// marker (ISO 10918-1, B.1.1.5), all other segments have their length (B.1.1.4).
inline bool has_jpeg_end(std::istream& stream) {
    constexpr int kFirstRestart = 0xd0, kStart = 0xd8, kEnd = 0xd9, kTemporary = 0x01;
    std::streambuf& bytes = *stream.rdbuf();
    const int none = std::streambuf::traits_type::eof();
    for (int byte = bytes.sbumpc(); byte != none; byte = bytes.sbumpc()) {
        if (byte != 0xff) continue;
        int marker = bytes.sbumpc();
        while (marker == 0xff) marker = bytes.sbumpc();
        if (marker == kEnd) return true;
        if (marker == 0 || marker == kTemporary || (marker >= kFirstRestart && marker <= kStart)) continue;
        const int high = bytes.sbumpc(), low = bytes.sbumpc();
        if (marker == none || high == none || low == none) return false;
        for (int left = (high << 8 | low) - 2; left > 0; --left)
            if (bytes.sbumpc() == none) return false;
    }
    return false;
}

} // namespace relief
