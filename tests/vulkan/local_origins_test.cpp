// Hits of a device on objects that lie far from the origin, beside exact arithmetic.
#include "gpu_fixture.h"
#include "support/far_objects.h"

namespace relief::vulkan::tests {
namespace {

class DeviceFarObjects : public GpuTest, public testing::WithParamInterface<test::FarCase> {};

TEST_P(DeviceFarObjects, are_hit_where_they_are) {
    IntersectorSettings settings;
    settings.device.engine = EngineKind::vulkan, settings.device.index = get_test_device_index();
    test::expect_right_hits(GetParam(), settings, 160);
}

INSTANTIATE_TEST_SUITE_P(Cases, DeviceFarObjects, testing::ValuesIn(test::list_far_cases()),
                         [](const auto& info) { return info.param.name; });

class DevicePictures : public GpuTest {};

TEST_F(DevicePictures, of_far_objects_are_those_of_near_ones) {
    RenderSettings settings;
    settings.device.engine = EngineKind::vulkan, settings.device.index = get_test_device_index();
    test::expect_picture_is_moved(settings);
}

} // namespace
} // namespace relief::vulkan::tests
