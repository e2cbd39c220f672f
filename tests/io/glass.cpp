// Keys of glass in scene files: read, written and read again, refused where they are wrong.
#include "io/scene/scene_reader.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

class GlassFiles : public FileTest {
  protected:
    GlassFiles() { write("plane.obj", kQuadObj); }
    Scene parse(const std::string& material) const {
        return parse_scene(R"({"materials": {"m": {)" + material + R"(}},
            "meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane", "material": "m"}]})",
                           folder_, "s.json");
    }
    std::string error_of(const std::string& material) const {
        return message_of([&] { parse(material); });
    }
};

TEST_F(GlassFiles, have_the_names_of_open_pbr) {
    Scene scene = parse(R"("transmission_weight": 0.31, "transmission_color": [0.32, 0.33, 0.34],
                           "transmission_depth": 35, "geometry_thin_walled": true)");
    for (int round = 0; round < 2; ++round) {
        const Material& glass = scene.materials.at(0);
        EXPECT_EQ(glass.transmission_weight, 0.31f);
        EXPECT_EQ(glass.transmission_color, (Vec3f{0.32f, 0.33f, 0.34f}));
        EXPECT_EQ(glass.transmission_depth, 35);
        EXPECT_TRUE(glass.is_thin_walled);
        save_scene(scene, folder_ / "glass");
        scene = load_scene(folder_ / "glass" / "scene.json");
    }
    EXPECT_FALSE(parse(R"("geometry_thin_walled": false)").materials.at(0).is_thin_walled);
    EXPECT_EQ(parse("").materials.at(0).transmission_weight, 0);
}

TEST_F(GlassFiles, are_refused_where_a_value_is_wrong) {
    EXPECT_HAS(error_of(R"("transmission_weight": 2)"),
               "materials.m.transmission_weight: must be in [0, 1], not 2");
    EXPECT_HAS(error_of(R"("transmission_color": [0, -1, 0])"), "materials.m.transmission_color[1]");
    EXPECT_HAS(error_of(R"("transmission_depth": -1)"), "materials.m.transmission_depth: must be at least 0");
    EXPECT_HAS(error_of(R"("geometry_thin_walled": 1)"), "materials.m.geometry_thin_walled");
    EXPECT_HAS(error_of(R"("transmision_weight": 1)"), "did you mean 'transmission_weight'?");
    EXPECT_HAS(error_of(R"("geometry_thin_wall": true)"), "did you mean 'geometry_thin_walled'?");
    EXPECT_HAS(error_of(R"("transmission_weight": 1, "coat_weight": 1)"),
               "transmission_weight and coat_weight exclude each other");
}

} // namespace relief
