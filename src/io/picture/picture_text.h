// Names that files bring with them, for messages.
#pragma once

#include <cstddef>
#include <string>

namespace relief {

/// The text with '?' in place of control characters and of bytes that are no UTF-8 (RFC 3629), which programs
/// that show messages refuse.
inline std::string make_printable(std::string text) {
    const auto byte = [&](size_t k) {
        return k < text.size() ? unsigned(static_cast<unsigned char>(text[k])) : 0u;
    };
    const auto is_next = [&](size_t k) { return (byte(k) & 0xc0u) == 0x80u; };
    for (size_t k = 0; k < text.size();) {
        const unsigned first = byte(k);
        const size_t length = first < 0x80   ? 1
                              : first < 0xc2 ? 0
                              : first < 0xe0 ? 2
                              : first < 0xf0 ? 3
                              : first < 0xf5 ? 4
                                             : 0;
        bool is_sound = length > 0 && first >= 0x20 && first != 0x7f;
        for (size_t next = 1; next < length; ++next) is_sound = is_sound && is_next(k + next);
        // Longer than needed, surrogates, and beyond the last character.
        if ((first == 0xe0 && byte(k + 1) < 0xa0) || (first == 0xed && byte(k + 1) >= 0xa0) ||
            (first == 0xf0 && byte(k + 1) < 0x90) || (first == 0xf4 && byte(k + 1) >= 0x90))
            is_sound = false;
        if (!is_sound) text[k] = '?';
        k += is_sound ? length : 1;
    }
    return text;
}

} // namespace relief
