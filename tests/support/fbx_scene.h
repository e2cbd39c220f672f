// FBX files of tests: the grid of fbx_text.h with properties, further objects and connections; and any
// records as a binary file.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "support/fbx_text.h"

namespace relief {

/// Model 20 holds geometry 10.
class FbxScene {
  public:
    explicit FbxScene(int side = 1) : text_(make_grid_fbx(side)) {}

    /// Adds records to the one whose text begins with `begin`, such as "Model: 20,".
    FbxScene& add(const std::string& begin, const std::string& records) {
        const size_t line = text_.find('\n', text_.find(begin));
        text_.insert(line + 1, records);
        return *this;
    }
    FbxScene& add_properties(const std::string& begin, const std::vector<std::string>& properties) {
        std::string records = "\t\tProperties70:  {\n";
        for (const std::string& property : properties) records += "\t\t\tP: " + property + "\n";
        return add(begin, records + "\t\t}\n");
    }
    FbxScene& add_object(const std::string& record) { return insert("}\nConnections:", record); }
    FbxScene& add_model(int id, const std::string& name, const std::string& kind = "Null") {
        return add_object("\tModel: " + std::to_string(id) + ", \"Model::" + name + "\", \"" + kind +
                          "\" {\n\t\tVersion: 232\n\t}\n");
    }
    FbxScene& connect(int source, int destination) {
        text_.insert(text_.rfind('}'),
                     "\tC: \"OO\"," + std::to_string(source) + "," + std::to_string(destination) + "\n");
        return *this;
    }
    FbxScene& replace(const std::string& old, const std::string& text) {
        text_.replace(text_.find(old), old.size(), text);
        return *this;
    }

    const std::string& text() const { return text_; }

  private:
    FbxScene& insert(const std::string& before, const std::string& text) {
        text_.insert(text_.find(before), text);
        return *this;
    }

    std::string text_;
};

/// An array record: name, values, count.
inline std::string make_fbx_array(const char* name, const std::string& values, size_t count) {
    return fbx_detail::make_array(name, values, count);
}

struct BinaryFbxOptions {
    bool is_big_endian = false;
    bool ends_are_left_out = false; ///< of records without children
    uint32_t version = 7400;        ///< below 7500
};

/// A binary file of one triangle: (0, 0, 0), (1, 0, 0), (0, 2, 0).
class BinaryFbx {
  public:
    explicit BinaryFbx(const BinaryFbxOptions& options) : options_(options) {
        bytes_ = std::string("Kaydara FBX Binary  \0\x1a", 22) + char(options.is_big_endian ? 1 : 0);
        number(options.version, 4);
        record("FBXHeaderExtension", "", [&] { record("FBXVersion", integer(options_.version)); });
        record("Objects", "", [&] {
            record("Geometry", id(10) + text(std::string("a\0\1Geometry", 11)) + text("Mesh"), [&] {
                record("Vertices", doubles({0, 0, 0, 1, 0, 0, 0, 2, 0}));
                record("PolygonVertexIndex", integers({0, 1, -3}));
            });
            record("Model", id(20) + text(std::string("a\0\1Model", 8)) + text("Mesh"),
                   [&] { record("Version", integer(232)); });
        });
        record("Connections", "", [&] {
            record("C", text("OO") + id(20) + id(0));
            record("C", text("OO") + id(10) + id(20));
        });
        bytes_.append(kNull, '\0');
    }

    const std::string& bytes() const { return bytes_; }

  private:
    static constexpr size_t kNull = 13; ///< bytes of a record of zeros

    std::string pack(uint64_t value, size_t width) const {
        std::string bytes;
        for (size_t k = 0; k < width; ++k)
            bytes += char(value >> (8 * (options_.is_big_endian ? width - 1 - k : k)));
        return bytes;
    }
    void number(uint64_t value, size_t width) { bytes_ += pack(value, width); }

    std::string integer(uint32_t value) const { return 'I' + pack(value, 4); }
    std::string id(uint64_t value) const { return 'L' + pack(value, 8); }
    std::string text(const std::string& value) const { return 'S' + pack(value.size(), 4) + value; }
    std::string head(char type, size_t count, size_t width) const {
        return type + pack(count, 4) + pack(0, 4) + pack(count * width, 4);
    }
    std::string doubles(const std::vector<double>& values) const {
        std::string bytes = head('d', values.size(), 8);
        for (const double value : values) {
            uint64_t bits = 0;
            std::memcpy(&bits, &value, sizeof bits);
            bytes += pack(bits, 8);
        }
        return bytes;
    }
    std::string integers(const std::vector<int>& values) const {
        std::string bytes = head('i', values.size(), 4);
        for (const int value : values) bytes += pack(uint32_t(value), 4);
        return bytes;
    }

    void record(const std::string& name, const std::string& values) {
        begin_record(name, values);
        if (!options_.ends_are_left_out) end_record(starts_.back());
        starts_.pop_back();
    }
    template <class Children>
    void record(const std::string& name, const std::string& values, const Children& children) {
        begin_record(name, values);
        children();
        bytes_.append(kNull, '\0');
        end_record(starts_.back());
        starts_.pop_back();
    }
    void begin_record(const std::string& name, const std::string& values) {
        starts_.push_back(bytes_.size());
        number(0, 4), number(count_values(values), 4), number(values.size(), 4), number(name.size(), 1);
        bytes_ += name + values;
    }
    void end_record(size_t start) { bytes_.replace(start, 4, pack(bytes_.size(), 4)); }

    /// Records of this file have none, one, or one text between ids or texts.
    static uint64_t count_values(const std::string& values) {
        if (values.empty()) return 0;
        return values[0] == 'S' || (values[0] == 'L' && values.size() > 9) ? 3 : 1;
    }

    BinaryFbxOptions options_;
    std::string bytes_;
    std::vector<size_t> starts_; ///< of open records
};

} // namespace relief
