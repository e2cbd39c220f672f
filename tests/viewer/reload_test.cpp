// Maps that another program writes while they are looked at: what is shown is always one of them, whole.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <ios>
#include <iterator>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "relief/io.h"
#include "viewer/workbench_fixture.h"

namespace relief::viewer {

namespace {

std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

} // namespace

class ReloadTest : public WorkbenchTest {
  protected:
    /// A map with a ridge at that row, as a file; and the scene's picture with it.
    void add_map(uint32_t row) {
        const std::filesystem::path file = find_map();
        Displacement map = bench_->document()->scene().displacements[0];
        auto texture = std::make_shared<Texture>(*make_bumps(false));
        for (uint32_t x = 0; x < 64; ++x) write_texel(*texture, x, row, {0, 0, 0.4f});
        map.tiles[0].texture = texture;
        write_map(map, folder_ / "next.exr", MapSamples::float32);
        files_.push_back(read_bytes(folder_ / "next.exr"));
        Scene scene = load_scene(folder_ / "scene.json");
        scene.displacements[0].tiles[0].texture = texture;
        pictures_.push_back(render(scene, settings_).image.pixels);
    }
    std::filesystem::path find_map() const { return folder_ / "maps" / "bumps.exr"; }
    /// Lets time go on until something is true; complete pictures must be those of whole maps.
    void look_until(const std::function<bool()>& is_true) {
        ASSERT_TRUE(reach([&] {
            if (bench_->is_done()) {
                const auto found = std::ranges::find(pictures_, bench_->picture()->image.pixels);
                EXPECT_NE(found, pictures_.end()) << "a torn picture";
                shown_.insert(size_t(found - pictures_.begin()));
            }
            return is_true();
        })) << bench_->message();
    }
    /// For a moment, in which not every change is seen.
    void look() {
        const auto start = std::chrono::steady_clock::now();
        look_until([&] { return std::chrono::steady_clock::now() - start > std::chrono::milliseconds(4); });
    }
    /// Until the map is shown.
    void look_for(const std::vector<float>& picture) {
        look_until([&] { return bench_->is_done() && bench_->picture()->image.pixels == picture; });
    }

    std::vector<std::string> files_;
    std::vector<std::vector<float>> pictures_;
    std::set<size_t> shown_;
};

TEST_F(ReloadTest, a_hundred_rewrites_also_half_written_ones_never_show_a_torn_picture) {
    open_scene();
    pictures_.push_back(bench_->picture()->image.pixels);
    for (const uint32_t row : {10u, 30u, 50u}) add_map(row);
    std::mt19937 dice(7);
    const auto has_told = [&] { return bench_->message().find("bumps.exr") != std::string::npos; };
    for (size_t k = 0; k < 100 && !HasFatalFailure(); ++k) {
        const bool is_seen = k % 20 == 0; // waits until it was read
        const size_t map = is_seen ? k / 20 % files_.size() : dice() % files_.size();
        const std::string& bytes = files_[map];
        if (k % 4 == 0) { // half of it first, also while that is read
            write_bytes(find_map(), bytes.substr(0, is_seen ? bytes.size() / 2 : 1 + dice() % bytes.size()));
            is_seen ? look_until(has_told) : look();
        }
        write_bytes(find_map(), bytes);
        is_seen ? look_for(pictures_[map + 1]) : look();
    }
    EXPECT_GE(shown_.size(), 3u);
}

TEST_F(ReloadTest, a_map_of_another_size_is_read_with_its_scene_and_the_camera_stays) {
    open_scene();
    press_key(kLeft);
    const Vec3f from = bench_->camera().get().from;
    Displacement map = bench_->document()->scene().displacements[0];
    auto texture = std::make_shared<Texture>(*map.tiles[0].texture);
    texture->width = texture->height = 32;
    texture->floats.resize(size_t(4) * 32 * 32);
    map.tiles[0].texture = texture;
    write_map(map, find_map(), MapSamples::float32);
    const auto get_width = [&] {
        return bench_->document()->scene().displacements[0].tiles[0].texture->width;
    };
    ASSERT_TRUE(reach([&] { return get_width() == 32; })) << bench_->message();
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_EQ(bench_->camera().get().from, from);
}

} // namespace relief::viewer
