// FBX files in binary: records with the byte at which each ends.
#include <algorithm>
#include <cstring>
#include <utility>

#include <zlib.h>

#include "io/mesh/fbx_document.h"

namespace relief {

namespace {

constexpr uint64_t kMostInflated = uint64_t(1) << 32; ///< bytes of an array

bool is_array(char type) { return std::string_view("fdlibc").find(type) != std::string_view::npos; }

size_t get_width(char type) {
    switch (type) {
    case 'Y':
        return 2;
    case 'I':
    case 'F':
    case 'i':
    case 'f':
        return 4;
    case 'D':
    case 'L':
    case 'd':
    case 'l':
        return 8;
    case 'B':
    case 'C':
    case 'Z':
    case 'b':
    case 'c':
        return 1;
    default:
        return 0;
    }
}

void append_number(std::string& bytes, uint64_t value, size_t width) {
    for (size_t k = 0; k < width; ++k) bytes += char(value >> (8 * k));
}

} // namespace

class FbxBinaryParser {
  public:
    FbxBinaryParser(std::string_view bytes, FbxDocument& document) : bytes_(bytes), document_(document) {}

    bool parse() {
        constexpr size_t kHead = 27, kEndianPlace = 22, kVersionPlace = 23;
        if (bytes_.size() < kHead) return false;
        is_big_endian_ = bytes_[kEndianPlace] == 1;
        at_ = kVersionPlace;
        document_.is_binary_ = true;
        document_.head_version_ = uint32_t(read_number(4));
        is_wide_ = document_.head_version_ >= 7500;
        return read_records(document_.root_, bytes_.size(), 0);
    }

  private:
    bool has(uint64_t count) const { return count <= bytes_.size() - at_; }

    uint64_t read_number(size_t width) {
        uint64_t value = 0;
        for (size_t k = 0; k < width; ++k) {
            const auto byte = uint64_t(uint8_t(bytes_[at_ + k]));
            value |= byte << (8 * (is_big_endian_ ? width - 1 - k : k));
        }
        at_ += width;
        return value;
    }

    /// Reads records up to one of zeros, or to `end`.
    bool read_records(FbxRecord& parent, uint64_t end, int depth) {
        const size_t width = is_wide_ ? 8 : 4;
        if (depth > kMostFbxNesting) return false;
        while (at_ < end) {
            if (!has(3 * width + 1)) return false;
            const uint64_t record_end = read_number(width), value_count = read_number(width),
                           value_bytes = read_number(width), name_size = read_number(1);
            if (record_end == 0 && name_size == 0) return true;
            if (!has(name_size)) return false;
            FbxRecord record;
            record.name = bytes_.substr(at_, name_size);
            at_ += name_size;
            if (!has(value_bytes) || at_ + value_bytes > end) return false;
            if (!read_values(record, value_count, at_ + value_bytes)) return false;
            if (record_end != 0) { // some writers leave it out where there are no children
                if (record_end < at_ || record_end > end) return false;
                record.has_scope = record_end > at_;
                if (!read_records(record, record_end, depth + 1)) return false;
                at_ = record_end;
            }
            parent.children.push_back(std::move(record));
        }
        return true;
    }

    bool read_values(FbxRecord& record, uint64_t count, uint64_t end) {
        if (count > end - at_) return false;
        for (; count > 0; --count) {
            if (at_ >= end) return false;
            const size_t begin = at_;
            const char type = bytes_[at_++];
            uint64_t size = get_width(type);
            if (type == 'S' || type == 'R') {
                if (end - at_ < 4) return false;
                size = read_number(4);
            } else if (is_array(type)) {
                if (end - at_ < 12) return false;
                at_ += 8;
                size = read_number(4);
            } else if (size == 0) {
                return false;
            }
            if (size > end - at_) return false;
            at_ += size;
            record.values.push_back(bytes_.substr(begin, at_ - begin));
            if (type == 'Z') record.values.back() = document_.keep(std::string("C") + bytes_[at_ - 1]);
            if (is_big_endian_ && !turn(record.values.back())) return false;
        }
        return at_ == end;
    }

    /// Makes a value little-endian.
    bool turn(std::string_view& value) {
        std::string turned(value);
        const auto reverse = [&](size_t place, size_t width) {
            std::reverse(turned.begin() + ptrdiff_t(place), turned.begin() + ptrdiff_t(place + width));
        };
        const char type = value[0];
        if (type == 'S' || type == 'R') {
            reverse(1, 4);
        } else if (is_array(type)) {
            for (const size_t place : {1, 5, 9}) reverse(place, 4);
            const auto plain = inflate_fbx_array(turned);
            if (!plain) return false;
            const size_t width = get_width(type);
            turned = std::string(1, type);
            append_number(turned, plain->size() / width, 4), append_number(turned, 0, 4);
            append_number(turned, plain->size(), 4);
            const size_t begin = turned.size();
            turned += *plain;
            for (size_t place = begin; place < turned.size(); place += width) reverse(place, width);
        } else {
            reverse(1, turned.size() - 1);
        }
        value = document_.keep(std::move(turned));
        return true;
    }

    std::string_view bytes_;
    FbxDocument& document_;
    size_t at_ = 0;
    bool is_big_endian_ = false, is_wide_ = false;
};

std::optional<std::string> inflate_fbx_array(std::string_view value) {
    constexpr size_t kHead = 13;
    if (value.size() < kHead || !is_array(value[0])) return {};
    uint32_t count = 0, coding = 0;
    std::memcpy(&count, value.data() + 1, 4);
    std::memcpy(&coding, value.data() + 5, 4);
    const uint64_t size = uint64_t(count) * get_width(value[0]);
    const std::string_view packed = value.substr(kHead);
    if (coding == 0) return packed.size() == size ? std::optional(std::string(packed)) : std::nullopt;
    // Deflate packs no more than 1032 bytes into one.
    if (coding != 1 || size >= kMostInflated || size / 1032 > packed.size()) return {};
    std::string plain(size, '\0');
    uLongf length = size;
    const int code = uncompress(reinterpret_cast<Bytef*>(plain.data()), &length,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (code != Z_OK || length != size) return {};
    return plain;
}

std::string pack_fbx_floats(std::span<const float> values) {
    std::string bytes = "f";
    const size_t size = values.size() * sizeof(float);
    append_number(bytes, values.size(), 4), append_number(bytes, 0, 4), append_number(bytes, size, 4);
    return bytes.append(reinterpret_cast<const char*>(values.data()), size);
}

bool parse_fbx_binary(std::string_view bytes, FbxDocument& document) {
    return FbxBinaryParser(bytes, document).parse();
}

namespace {

constexpr uint32_t kWrittenVersion = 7500; ///< the first one whose records have places of 64 bits
constexpr size_t kRecordHead = 25;

void append_record(std::string& bytes, const FbxRecord& record) {
    const size_t begin = bytes.size();
    size_t value_bytes = 0;
    for (const std::string_view value : record.values) value_bytes += value.size();
    append_number(bytes, 0, 8), append_number(bytes, record.values.size(), 8);
    append_number(bytes, value_bytes, 8), append_number(bytes, record.name.size(), 1);
    bytes += record.name;
    for (const std::string_view value : record.values) bytes += value;
    if (record.has_scope) {
        for (const FbxRecord& child : record.children) append_record(bytes, child);
        bytes.append(kRecordHead, '\0');
    }
    std::string end;
    append_number(end, bytes.size(), 8);
    bytes.replace(begin, end.size(), end);
}

} // namespace

std::string write_fbx_binary(const FbxRecord& root) {
    std::string bytes(kFbxMagic);
    bytes += std::string_view("  \0\x1a\0", 5);
    append_number(bytes, kWrittenVersion, 4);
    for (const FbxRecord& record : root.children) append_record(bytes, record);
    bytes.append(kRecordHead, '\0');
    return bytes;
}

} // namespace relief
