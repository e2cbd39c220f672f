// Structs that cross between host and device have the same fields in the same places.
#include <bit>
#include <vector>

#include <gtest/gtest.h>

#include "formulas/light_source.h"
#include "formulas/light_tree.h"
#include "formulas/tree.h"
#include "lab/walks/trail.h"
#include "vulkan/device/commands.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_raster.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/layout/device_scene.h"
#include "vulkan/layout/device_sort.h"
#include "vulkan/layout/device_trees.h"
#include "vulkan/test_shaders.h"

namespace relief::scalar {
#include "vulkan/shaders/device_fields-inl.h"
} // namespace relief::scalar

namespace relief::vulkan::tests {
namespace {

static_assert(sizeof(scalar::InstanceData) == 33 * 4);
static_assert(sizeof(scalar::InstanceData) * 1000000 <= 1 << 27, "one buffer holds a million instances");
static_assert(sizeof(scalar::SurfaceData) == 20 * 4);
static_assert(sizeof(scalar::MapData) == 19 * 4);
static_assert(sizeof(scalar::TextureData) == 5 * 4);
static_assert(sizeof(scalar::MaterialData) == 59 * 4);
static_assert(sizeof(scalar::MaterialInputData) == 64 * 4);
static_assert(sizeof(scalar::InputTextureData) == 12 * 4);
static_assert(sizeof(scalar::TileRecord) == 5 * 4);
static_assert(sizeof(scalar::RayData) == 9 * 4);
static_assert(sizeof(scalar::HitData) == 7 * 4);
static_assert(sizeof(scalar::CastPush) <= scalar::kMaxPushBytes);
static_assert(sizeof(scalar::CameraPush) <= scalar::kMaxPushBytes);
static_assert(sizeof(scalar::PathPush) <= scalar::kMaxPushBytes);
static_assert(sizeof(scalar::TreeRay) == 8 * 4);
static_assert(sizeof(scalar::TreeHit) == 4 * 4);
static_assert(sizeof(scalar::WalkPush) <= scalar::kMaxPushBytes);

/// Distinct numbers; as floats normal, because devices may flush others.
class Numbers {
  public:
    void put(uint32_t& field) { field = add(); }
    void put(float& field) { field = std::bit_cast<float>(add()); }
    const std::vector<uint32_t>& all() const { return all_; }

  private:
    uint32_t add() {
        all_.push_back(0x3f800000u + uint32_t(all_.size()) * 3);
        return all_.back();
    }
    std::vector<uint32_t> all_;
};

class CrossingStructs : public GpuTest {};

TEST_F(CrossingStructs, have_the_same_fields_on_the_device) {
    std::vector<scalar::AllStructs> structs(2);
    Numbers numbers;
#define FIELD(path) numbers.put(path);
    ALL_FIELDS(structs[1])
#undef FIELD
    ASSERT_EQ(numbers.all().size() * sizeof(uint32_t), sizeof(scalar::AllStructs)) << "a field is not listed";
    Buffer from(device(), {.name = "structs", .bytes = structs.size() * sizeof(structs[0])});
    const Buffer words(device(), {.name = "words", .bytes = sizeof(scalar::AllStructs)});
    from.upload(structs);
    BindingTable bindings(device());
    bindings.bind(scalar::kBindRays, from);
    bindings.bind(scalar::kBindFilm, words);
    const Kernel kernel = make_test_kernel(device(), "read_fields");
    vulkan::Commands commands(device(), bindings);
    commands.dispatch(kernel, 1, 0u);
    commands.run();
    EXPECT_EQ(words.download<uint32_t>(numbers.all().size()), numbers.all());
}

} // namespace
} // namespace relief::vulkan::tests
