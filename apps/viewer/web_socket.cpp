#include "viewer/web_socket.h"

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

namespace relief::viewer {

namespace {

using Digest = std::array<uint32_t, 5>;

void add_block(Digest& digest, std::string_view block) {
    std::array<uint32_t, 80> words{};
    for (size_t k = 0; k < 64; ++k)
        words[k / 4] |= uint32_t(static_cast<unsigned char>(block[k])) << (24 - 8 * (k % 4));
    for (size_t k = 16; k < 80; ++k)
        words[k] = std::rotl(words[k - 3] ^ words[k - 8] ^ words[k - 14] ^ words[k - 16], 1);
    auto [a, b, c, d, e] = digest;
    for (size_t k = 0; k < 80; ++k) {
        const uint32_t mixed = k < 20   ? (b & c) | (~b & d)
                               : k < 40 ? b ^ c ^ d
                               : k < 60 ? (b & c) | (b & d) | (c & d)
                                        : b ^ c ^ d;
        constexpr std::array<uint32_t, 4> kConstants = {0x5A827999, 0x6ED9EBA1, 0x8F1BBCDC, 0xCA62C1D6};
        const uint32_t next = std::rotl(a, 5) + mixed + e + kConstants[k / 20] + words[k];
        e = d, d = c, c = std::rotl(b, 30), b = a, a = next;
    }
    const std::array<uint32_t, 5> sums = {a, b, c, d, e};
    for (size_t k = 0; k < 5; ++k) digest[k] += sums[k];
}

/// FIPS 180-4 (2015), section 6.1. The protocol asks for it; nothing here is kept secret by it.
std::string compute_sha1(std::string text) {
    const uint64_t bits = 8 * uint64_t(text.size());
    text += '\x80';
    while (text.size() % 64 != 56) text += '\0';
    for (int shift = 56; shift >= 0; shift -= 8) text += char(bits >> shift);
    Digest digest = {0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
    for (size_t at = 0; at < text.size(); at += 64) add_block(digest, std::string_view(text).substr(at, 64));
    std::string bytes;
    for (const uint32_t word : digest)
        for (int shift = 24; shift >= 0; shift -= 8) bytes += char(word >> shift);
    return bytes;
}

std::string encode_base64(const std::string& bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t at = 0; at < bytes.size(); at += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (at + k < bytes.size() ? static_cast<unsigned char>(bytes[at + k]) : 0u);
        for (size_t k = 0; k < 4; ++k)
            text += at + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

constexpr unsigned kText = 1, kClose = 8, kPing = 9, kPong = 10, kContinuation = 0;
constexpr size_t kMostControlBytes = 125;

SocketFrame::Kind name_kind(unsigned code) {
    if (code == kText || code == kContinuation) return SocketFrame::Kind::text;
    if (code == kPing) return SocketFrame::Kind::ping;
    return code == kClose ? SocketFrame::Kind::close : SocketFrame::Kind::other;
}

std::string make_control(unsigned code, const std::string& content) {
    const std::string cut = content.substr(0, kMostControlBytes);
    return std::string{char(0x80 | code), char(cut.size())} + cut;
}

} // namespace

std::string make_accept_key(const std::string& key) {
    return encode_base64(compute_sha1(key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"));
}

FrameFault read_frame(const std::string& buffer, SocketFrame& frame) {
    const auto byte = [&](size_t k) { return unsigned(static_cast<unsigned char>(buffer[k])); };
    if (buffer.size() < 2) return FrameFault::incomplete;
    const bool is_masked = (byte(1) & 0x80) != 0, has_extensions = (byte(0) & 0x70) != 0;
    if (!is_masked || has_extensions) return FrameFault::refused;
    uint64_t size = byte(1) & 0x7F;
    size_t at = 2;
    const size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (buffer.size() < at + more) return FrameFault::incomplete;
    if (more > 0) size = 0;
    for (size_t k = 0; k < more; ++k) size = size << 8 | byte(at++);
    if (size > kMostMessageBytes) return FrameFault::refused;
    if (buffer.size() < at + 4 + size) return FrameFault::incomplete;
    const size_t mask = at;
    at += 4;
    frame.content.clear();
    for (size_t k = 0; k < size; ++k) frame.content += char(byte(at + k) ^ byte(mask + k % 4));
    frame.kind = name_kind(byte(0) & 15), frame.is_last = (byte(0) & 0x80) != 0;
    frame.bytes = at + size;
    return FrameFault::none;
}

std::string make_pong(const std::string& content) { return make_control(kPong, content); }
std::string make_close() { return make_control(kClose, {}); }

} // namespace relief::viewer
