// A glTF document of a test, and its mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/mesh/mesh_gltf.h"
#include "relief/error.h"

namespace relief {

using GltfJson = nlohmann::json;

/// In the making: accessors have bytes of their own, in one buffer.
class GltfDocument {
  public:
    using Json = GltfJson;

    GltfDocument() {
        json = {
            {"asset", {{"version", "2.0"}}}, {"accessors", Json::array()}, {"bufferViews", Json::array()}};
    }

    template <class T> int add(const std::string& type, int component, const std::vector<T>& values) {
        const size_t width = type == "SCALAR" ? 1 : size_t(type.back() - '0');
        const size_t bytes = values.size() * sizeof(T);
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes}});
        buffer.append(reinterpret_cast<const char*>(values.data()), bytes);
        buffer.resize((buffer.size() + 3) / 4 * 4);
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", component},
                                     {"count", values.size() / width},
                                     {"type", type}});
        return int(json["accessors"].size()) - 1;
    }
    int add_floats(const std::string& type, const std::vector<float>& values) {
        return add(type, 5126, values);
    }

    std::string make_glb() const {
        Json whole = json;
        whole["buffers"] = {{{"byteLength", buffer.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const auto word = [](size_t value) {
            const auto number = uint32_t(value);
            return std::string(reinterpret_cast<const char*>(&number), 4);
        };
        return "glTF" + word(2) + word(28 + text.size() + buffer.size()) + word(text.size()) + "JSON" + text +
               word(buffer.size()) + std::string("BIN\0", 4) + buffer;
    }

    Json json;
    std::string buffer;
};

inline const std::vector<float> kGltfSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// A square as one primitive of one mesh, without nodes.
inline GltfDocument make_gltf_square() {
    GltfDocument document;
    const int positions = document.add_floats("VEC3", kGltfSquare);
    const int indices = document.add<uint16_t>("SCALAR", 5123, {0, 1, 2, 0, 2, 3});
    document.json["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
    return document;
}

inline nlohmann::json& primitive_of(GltfDocument& document) {
    return document.json["meshes"][0]["primitives"][0];
}

/// In place of files beside it.
inline std::string refuse(const std::string& path) {
    throw Error(ErrorKind::bad_input, {"there is no file " + path, "", "make one"});
}

inline Mesh parse_document(const GltfDocument& document, const MeshReadOptions& options = {}) {
    return parse_gltf(document.make_glb(), "m.glb", refuse, options);
}

} // namespace relief
