#include "io/picture/tiff_header.h"

#include <array>
#include <cstdint>

namespace relief {

namespace {

class TiffBytes {
  public:
    explicit TiffBytes(std::istream& stream) : stream_(stream) {
        std::array<char, 2> order{};
        stream_.read(order.data(), 2);
        is_big_ = order[0] == 'M' && order[1] == 'M';
        is_good_ = is_big_ || (order[0] == 'I' && order[1] == 'I');
    }

    /// Zero, and no longer good, past the end.
    uint32_t read(size_t byte_count) {
        std::array<unsigned char, 4> bytes{};
        if (!stream_.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(byte_count)))
            is_good_ = false;
        uint32_t value = 0;
        for (size_t k = 0; k < byte_count; ++k) value = value << 8 | bytes[is_big_ ? k : byte_count - 1 - k];
        return value;
    }
    void seek(uint32_t position) { stream_.seekg(std::streamoff(position)); }
    bool is_good() const { return is_good_; }

  private:
    std::istream& stream_;
    bool is_big_ = false, is_good_ = false;
};

} // namespace

std::string find_tiff_color_tag(std::istream& stream) {
    constexpr uint32_t kVersion = 42, kIccProfile = 34675;
    TiffBytes bytes(stream);
    if (!bytes.is_good() || bytes.read(2) != kVersion) return {};
    bytes.seek(bytes.read(4));
    const uint32_t entry_count = bytes.read(2);
    for (uint32_t k = 0; k < entry_count && bytes.is_good(); ++k) {
        if (bytes.read(2) == kIccProfile && bytes.is_good()) return "ICC profile";
        bytes.read(2), bytes.read(4), bytes.read(4);
    }
    return {};
}

} // namespace relief
