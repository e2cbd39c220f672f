// One displacement, written in every way that programs write it, gives one surface.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <OpenImageIO/half.h>

#include "io/test_files.h"
#include "relief/io.h"
#include "relief/render.h"

namespace relief {

namespace {

constexpr int kSize = 16;
constexpr float kReach = 0.6f; ///< no displacement is longer along any axis

/// Displacement along t, b, n at a texel: a bump that leans over.
std::array<float, 3> displace(int x, int y) {
    constexpr float kPi = std::numbers::pi_v<float>;
    const float u = float(x) / (kSize - 1), v = float(y) / (kSize - 1);
    const float bump = std::sin(kPi * u) * std::sin(kPi * v);
    return {0.25f * bump * bump, -0.15f * bump, 0.55f * bump};
}

/// All texels; `code` turns one component into what the file holds.
template <class Value, class Code>
std::vector<Value> make_texels(const std::array<int, 3>& order, const Code& code) {
    std::vector<Value> texels;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            for (const int axis : order) texels.push_back(code(displace(x, y)[size_t(axis)]));
    return texels;
}

template <class Value> Value quantise(float value) {
    constexpr float kLargest = float(std::numeric_limits<Value>::max());
    return Value(std::lround((value / (2 * kReach) + 0.5f) * kLargest));
}

uint16_t encode_half(float value) { return half(value).bits(); }

} // namespace

class MapCodings : public FileTest {
  protected:
    MapCodings() { write("plane.obj", kQuadObj); }

    Image render_depth(const std::string& map) const {
        const std::string text =
            R"({"meshes": {"plane": {"file": "plane.obj"}}, "displacements": {"map": {)" + map +
            R"(}}, "objects": [{"mesh": "plane", "displacement": "map"}],
             "camera": {"from": [1.5, -1, 4], "to": [0, 0, 0.2]}})";
        write("scene.json", text);
        RenderSettings settings;
        settings.image.width = settings.image.height = 96;
        settings.image.spp = 1;
        settings.image.bounces = 0;
        settings.surface.level = 5;
        settings.image.layers = {"depth"};
        return render(load_scene(folder_ / "scene.json"), settings).image;
    }

    /// Depths differ by at most `step` times a factor for slanted rays; a silhouette may move by a pixel.
    void expect_same(const Image& a, const Image& b, float step) const {
        const size_t depth = a.find_channel("depth.Z").value();
        int hits = 0, strays = 0;
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x) {
                const float p = a.at(x, y, depth), q = b.at(x, y, depth);
                if (std::isinf(p) && std::isinf(q)) continue;
                ++hits;
                if (!(std::fabs(p - q) <= 4 * step)) ++strays;
            }
        EXPECT_GT(hits, 2000);
        EXPECT_LE(strays, hits / 200) << "of " << hits;
    }
};

TEST_F(MapCodings, all_give_the_same_surface_up_to_their_steps) {
    const std::array<int, 3> tbn{0, 1, 2}, tnb{0, 2, 1};
    const auto as_float = [](float value) { return value; };
    write_pixels<float>("f.exr", kSize, kSize, 3, OIIO::TypeDesc::FLOAT, make_texels<float>(tbn, as_float));
    write_pixels<uint16_t>("h.exr", kSize, kSize, 3, OIIO::TypeDesc::HALF,
                           make_texels<uint16_t>(tbn, encode_half));
    write_pixels<float>("f.tif", kSize, kSize, 3, OIIO::TypeDesc::FLOAT, make_texels<float>(tnb, as_float));
    write_pixels<uint16_t>("w.png", kSize, kSize, 3, OIIO::TypeDesc::UINT16,
                           make_texels<uint16_t>(tbn, quantise<uint16_t>));
    write_pixels<uint8_t>("b.png", kSize, kSize, 3, OIIO::TypeDesc::UINT8,
                          make_texels<uint8_t>(tbn, quantise<uint8_t>));

    const Image reference = render_depth(R"("file": "f.exr", "preset": "blender-brush")");
    expect_same(reference, render_depth(R"("file": "f.tif", "preset": "mudbox")"), 0);
    expect_same(reference, render_depth(R"("file": "h.exr", "preset": "genvdm")"), kReach / 2048);
    const std::string integer = R"(, "preset": "genvdm", "midlevel": 0.5, "scale": 1.2)";
    expect_same(reference, render_depth(R"("file": "w.png")" + integer), 2 * kReach / 65535);
    expect_same(reference, render_depth(R"("file": "b.png")" + integer), 2 * kReach / 255);
    // The comparison is able to fail: the same numbers in another order are another surface.
    const Image other = render_depth(R"("file": "f.tif", "preset": "genvdm")");
    const size_t depth = other.find_channel("depth.Z").value();
    float largest = 0;
    for (int y = 0; y < other.height; ++y)
        for (int x = 0; x < other.width; ++x) {
            const float difference = std::fabs(other.at(x, y, depth) - reference.at(x, y, depth));
            if (std::isfinite(difference)) largest = std::max(largest, difference);
        }
    EXPECT_GT(largest, 0.2f);
}

} // namespace relief
