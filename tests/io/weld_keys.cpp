// The key "weld" of a mesh, and the option of a mesh that comes alone.
#include <limits>

#include "io/scene_files.h"
#include "relief/io.h"

namespace relief {

class WeldKeys : public SceneFiles {
  protected:
    Scene parse_weld(const std::string& weld) const {
        return parse(R"({"meshes": {"plane": {"file": "plane.obj", "weld": )" + weld +
                     R"(}}, "objects": [{"mesh": "plane"}]})");
    }
};

TEST_F(WeldKeys, are_distances_of_zero_or_more) {
    EXPECT_EQ(parse_weld("0").meshes.at(0).weld, std::optional(0.0f));
    EXPECT_EQ(parse_weld("1e-4").meshes.at(0).weld, std::optional(1e-4f));
    EXPECT_EQ(parse(with_object("")).meshes.at(0).weld, std::nullopt);
    EXPECT_HAS(message_of([&] { parse_weld("-1"); }), "meshes.plane.weld");
    EXPECT_HAS(message_of([&] { parse_weld("true"); }), "meshes.plane.weld");
    Scene scene = parse_weld("0");
    scene.meshes[0].weld = std::numeric_limits<float>::quiet_NaN();
    EXPECT_HAS(message_of([&] { validate_scene(scene); }), "weld is nan");
}

TEST_F(WeldKeys, are_saved_and_part_of_the_hash) {
    const Scene scene = parse_weld("0.25");
    save_scene(scene, folder_ / "saved");
    EXPECT_EQ(load_scene(folder_ / "saved" / "scene.json").meshes.at(0).weld, std::optional(0.25f));
    EXPECT_NE(scene.hash, parse_weld("0").hash);
    EXPECT_NE(parse(with_object("")).hash, parse_weld("0").hash);
    MeshSceneOptions options;
    options.weld = 0.125f;
    const Scene alone = load_mesh_scene(folder_ / "plane.obj", options);
    EXPECT_EQ(alone.meshes.at(0).weld, options.weld);
    save_scene_copy(alone, folder_ / "plane.obj", options, folder_ / "copy.json");
    EXPECT_EQ(load_scene(folder_ / "copy.json").meshes.at(0).weld, options.weld);
}

} // namespace relief
