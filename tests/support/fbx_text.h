// FBX files as text (7.4, ASCII): a grid of quads with uvs, and a node that is its own child.
#pragma once

#include <string>

namespace relief {

namespace fbx_detail {

inline std::string make_array(const char* name, const std::string& values, size_t count) {
    return std::string("\t\t") + name + ": *" + std::to_string(count) + " {\n\t\t\ta: " + values +
           "\n\t\t}\n";
}

inline std::string make_document(const std::string& objects, const std::string& connections) {
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: "
           "7400\n}\n"
           "Objects:  {\n" +
           objects + "}\nConnections:  {\n" + connections + "}\n";
}

} // namespace fbx_detail

/// `side` x `side` quads of the unit square, their points on z = x y, with uvs.
/// `has_bare_part`: a second mesh, without uvs, beside it.
inline std::string make_grid_fbx(int side, bool has_bare_part = false) {
    std::string points, uvs, corners, uv_corners;
    const auto add = [](std::string& list, const std::string& value) {
        if (!list.empty()) list += ',';
        list += value;
    };
    for (int j = 0; j <= side; ++j) {
        for (int i = 0; i <= side; ++i) {
            const double x = double(i) / side, y = double(j) / side;
            for (const double value : {x, y, x * y}) add(points, std::to_string(value));
            for (const double value : {x, y}) add(uvs, std::to_string(value));
        }
    }
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const int first = j * (side + 1) + i, above = first + side + 1;
            for (const int corner : {first, first + 1, above + 1, -above - 1}) // the last one is marked
                add(corners, std::to_string(corner));
            for (const int corner : {first, first + 1, above + 1, above})
                add(uv_corners, std::to_string(corner));
        }
    }
    using fbx_detail::make_array;
    const size_t point_count = size_t(side + 1) * size_t(side + 1),
                 corner_count = 4 * size_t(side) * size_t(side);
    const std::string bare = has_bare_part
                                 ? "\tGeometry: 11, \"Geometry::bare\", \"Mesh\" {\n" +
                                       make_array("Vertices", points, 3 * point_count) +
                                       make_array("PolygonVertexIndex", corners, corner_count) +
                                       "\t\tGeometryVersion: 124\n\t}\n"
                                       "\tModel: 21, \"Model::bare\", \"Mesh\" {\n\t\tVersion: 232\n\t}\n"
                                 : std::string();
    return fbx_detail::make_document(
        bare + "\tGeometry: 10, \"Geometry::grid\", \"Mesh\" {\n" +
            make_array("Vertices", points, 3 * point_count) +
            make_array("PolygonVertexIndex", corners, corner_count) +
            "\t\tGeometryVersion: 124\n\t\tLayerElementUV: 0 {\n\t\tVersion: 101\n\t\tName: \"map1\"\n"
            "\t\tMappingInformationType: \"ByPolygonVertex\"\n"
            "\t\tReferenceInformationType: \"IndexToDirect\"\n" +
            make_array("UV", uvs, 2 * point_count) + make_array("UVIndex", uv_corners, corner_count) +
            "\t\t}\n\t\tLayer: 0 {\n\t\tVersion: 100\n\t\tLayerElement:  {\n\t\tType: \"LayerElementUV\"\n"
            "\t\tTypedIndex: 0\n\t\t}\n\t\t}\n\t}\n"
            "\tModel: 20, \"Model::grid\", \"Mesh\" {\n\t\tVersion: 232\n\t}\n",
        std::string("\tC: \"OO\",20,0\n\tC: \"OO\",10,20\n") +
            (has_bare_part ? "\tC: \"OO\",21,0\n\tC: \"OO\",11,21\n" : ""));
}

/// A node that is connected to itself. Who follows children by recursion runs out of stack.
inline std::string make_endless_fbx() {
    return fbx_detail::make_document("\tModel: 1, \"Model::a\", \"Null\" {\n\t\tVersion: 232\n\t}\n",
                                     "\tC: \"OO\",1,0\n\tC: \"OO\",1,1\n");
}

} // namespace relief
