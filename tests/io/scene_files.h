// Scene files of a test, in a folder with a plane and a map.
#pragma once

#include <string>

#include "io/scene/scene_reader.h"
#include "io/test_files.h"

namespace relief {

class SceneFiles : public FileTest {
  protected:
    SceneFiles() {
        write("plane.obj", kQuadObj);
        write_pixels<float>("map.exr", 2, 2, 3, OIIO::TypeDesc::FLOAT,
                            {0, 0, 1, 0, 0, 0, 0, 0, 0, 0, .5f, 0});
    }
    Scene parse(const std::string& text) const { return parse_scene(text, folder_, "s.json"); }
    std::string error_of(const std::string& text) const {
        return message_of([&] { parse(text); });
    }
    std::string with_object(const std::string& members) const {
        return R"({"meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane")" + members +
               "}]}";
    }
    std::string with_map(const std::string& members) const {
        return R"({"displacements": {"ear": {)" + members + "}}}";
    }
};

} // namespace relief
