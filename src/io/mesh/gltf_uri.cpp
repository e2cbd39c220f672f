#include "io/mesh/gltf_uri.h"

#include <cstdint>
#include <filesystem>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

[[noreturn]] void refuse_uri(const std::string& message, const std::string& hint) {
    throw Error(ErrorKind::bad_input, {message, "", hint});
}

/// Value of a digit of base64, or 64.
uint32_t decode_digit(char c) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const size_t place = kDigits.find(c);
    return place == std::string_view::npos ? 64 : uint32_t(place);
}

/// Value of a hexadecimal digit, or 16.
int decode_hex(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : 16;
}

} // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::string decode_data_uri(std::string_view uri) {
    constexpr std::string_view kMark = ";base64,";
    const size_t mark = uri.find(kMark);
    if (mark == std::string_view::npos) refuse_uri("holds data that is not in base64", "export it again");
    std::string_view text = uri.substr(mark + kMark.size());
    while (text.ends_with('=')) text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const uint32_t digit = decode_digit(c);
        if (digit == 64)
            refuse_uri(
                fmt::format("has byte {} where base64 must be", unsigned(static_cast<unsigned char>(c))),
                "the file is damaged: export it again");
        bits = bits << 6 | digit;
        bit_count += 6;
        if (bit_count >= 8) bit_count -= 8, bytes.push_back(char(bits >> bit_count & 0xff));
    }
    return bytes;
}

std::string decode_path_uri(std::string_view uri) {
    std::string path;
    for (size_t i = 0; i < uri.size(); ++i) {
        const int high = uri[i] == '%' && i + 2 < uri.size() ? decode_hex(uri[i + 1]) : 16;
        const int low = high < 16 ? decode_hex(uri[i + 2]) : 16;
        if (low < 16)
            path.push_back(char(high << 4 | low)), i += 2;
        else
            path.push_back(uri[i]);
    }
    const std::filesystem::path plain = std::filesystem::path(path).lexically_normal();
    const bool is_web = path.find("://") != std::string::npos || path.starts_with("file:");
    if (path.empty() || path.find('\0') != std::string::npos || is_web || plain.is_absolute() ||
        *plain.begin() == "..")
        refuse_uri(fmt::format("'{}' is no file in the folder of the glTF file or below", uri),
                   "keep the buffers beside the file, or export as GLB");
    return plain.string();
}

} // namespace relief
