// A bumpy plane, in memory and in files, for tests of the viewer.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "relief/render.h"
#include "relief/scene.h"
#include "viewer/render_loop.h"

namespace relief::viewer {

/// 64 x 64 texels, halves where asked for.
std::shared_ptr<const Texture> make_bumps(bool has_halves);

/// Four quads over [-1, 1]^2 that face +z, displaced by bumps along n, seen from the front.
Scene make_bumpy_scene(DisplacementSpace space = DisplacementSpace::tangent, bool has_halves = false);

/// 48 x 32 pixels with the layers of the viewer.
RenderSettings make_small_settings(int spp = 4);

/// What a render of the scene looks like to the viewer.
ShownPicture make_picture(const Scene& scene, const RenderSettings& settings);

/// Calls `is_true` until it is, at most for a minute.
bool wait_until(const std::function<bool()>& is_true);

/// Values of one channel.
std::vector<float> get_channel(const Image& image, const std::string& name);

/// A fresh folder a test.
class FolderTest : public testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;
    /// plane.obj and bumps.exr, and scene.json with both.
    void write_scene_files();
    std::filesystem::path folder_;
};

} // namespace relief::viewer
