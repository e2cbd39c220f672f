#include "viewer/fixture.h"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <thread>

#include <unistd.h>

#include "common/texel_values.h"
#include "relief/io.h"
#include "viewer/surface_point.h"

namespace relief::viewer {

std::shared_ptr<const Texture> make_bumps(bool has_halves) {
    Texture texture;
    texture.width = texture.height = 64;
    texture.channel_count = 3;
    texture.source_type = has_halves ? SampleType::float16 : SampleType::float32;
    const size_t count = size_t(4) * 64 * 64;
    if (has_halves)
        texture.halves.assign(count, 0x3c00);
    else
        texture.floats.assign(count, 1);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x)
            write_texel(texture, x, y, {0, 0, 0.1f * std::sin(float(x) * 0.4f) * std::sin(float(y) * 0.3f)});
    return std::make_shared<const Texture>(std::move(texture));
}

Scene make_bumpy_scene(DisplacementSpace space, bool has_halves) {
    Mesh mesh;
    mesh.name = "plane";
    for (int y = 0; y <= 2; ++y)
        for (int x = 0; x <= 2; ++x) {
            mesh.positions.push_back({float(x) - 1, float(y) - 1, 0});
            mesh.uvs.push_back({float(x) / 2, float(y) / 2});
        }
    for (uint32_t y = 0; y < 2; ++y)
        for (uint32_t x = 0; x < 2; ++x) {
            const uint32_t first = 3 * y + x;
            mesh.face_sizes.push_back(4);
            for (const uint32_t k : {first, first + 1, first + 4, first + 3})
                mesh.position_indices.push_back(k), mesh.uv_indices.push_back(k);
        }
    Displacement map;
    map.name = "bumps";
    map.space = space;
    map.tiles = {{1001, make_bumps(has_halves)}};
    Scene scene;
    scene.meshes = {mesh};
    scene.displacements = {map};
    Material clay;
    clay.name = "clay";
    scene.materials = {clay};
    Object object;
    object.name = "plane";
    object.displacement = 0;
    object.material = 0;
    scene.objects = {object};
    scene.environment.emplace();
    scene.camera.from = {0, 0, 4};
    return scene;
}

RenderSettings make_small_settings(int spp) {
    RenderSettings settings;
    settings.image.width = 48, settings.image.height = 32;
    settings.image.spp = spp;
    settings.image.layers.assign(std::begin(kViewerLayers), std::end(kViewerLayers));
    return settings;
}

ShownPicture make_picture(const Scene& scene, const RenderSettings& settings) {
    ShownPicture picture;
    picture.image = render(scene, settings).image;
    picture.camera = scene.camera;
    picture.full_width = settings.image.width, picture.full_height = settings.image.height;
    return picture;
}

bool wait_until(const std::function<bool()>& is_true) {
    const auto start = std::chrono::steady_clock::now();
    while (!is_true()) {
        if (std::chrono::steady_clock::now() - start > std::chrono::seconds(60)) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

std::vector<float> get_channel(const Image& image, const std::string& name) {
    std::vector<float> values;
    const size_t channel = image.find_channel(name).value();
    for (size_t k = channel; k < image.pixels.size(); k += image.channels.size())
        values.push_back(image.pixels[k]);
    return values;
}

void FolderTest::SetUp() {
    const testing::TestInfo& info = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("relief_viewer_") + info.name() + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
}

void FolderTest::TearDown() { std::filesystem::remove_all(folder_); }

void FolderTest::write_scene_files() { save_scene(make_bumpy_scene(), folder_); }

} // namespace relief::viewer
