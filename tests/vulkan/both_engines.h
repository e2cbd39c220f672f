// A picture by a device and by the CPU engine, of the same random numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cpu/cpu_engine.h"
#include "support/shading_scenes.h"
#include "vulkan/path_tracer.h"

namespace relief::vulkan::tests {

/// A path may go another way for a rounding.
inline void expect_close(const Image& found, const Image& expected) {
    ASSERT_EQ(found.pixels.size(), expected.pixels.size());
    size_t apart = 0;
    double sum = 0, expected_sum = 0;
    for (size_t k = 0; k < found.pixels.size(); ++k) {
        const float wanted = expected.pixels[k];
        if (std::fabs(found.pixels[k] - wanted) > 2e-3f * std::max(1.0f, std::fabs(wanted))) ++apart;
        sum += double(found.pixels[k]), expected_sum += double(wanted);
    }
    EXPECT_LT(apart, found.pixels.size() / 20);
    EXPECT_NEAR(sum, expected_sum, 0.01 * std::fabs(expected_sum));
}

/// By the device, of 16 x 16 pixels.
inline Image trace_picture(const Device& device, const PreparedScene& prepared,
                           const RenderSettings& settings) {
    const DeviceScene device_scene(device, prepared);
    Tracer tracer(device, prepared, device_scene, settings, {.ray_capacity = 4096});
    PathTracer path_tracer(tracer, settings);
    Film film(16, 16, settings.image.crop, settings.image.layers);
    const PixelRange range{film.window(), 0, 16 * 16};
    path_tracer.trace_samples(film, {&range, 1}, {0, settings.image.spp});
    return film.resolve();
}

/// Of 16 x 16 pixels with these layers.
inline void expect_engines_agree(const Device& device, Scene scene, int spp,
                                 std::vector<std::string> layers) {
    RenderSettings settings = make_small_settings(16, spp, 4);
    settings.image.layers = std::move(layers);
    const auto prepared = prepare_scene(std::move(scene), settings);
    Film same(16, 16, settings.image.crop, settings.image.layers);
    make_cpu_engine(prepared, settings)->render(same, nullptr);
    expect_close(trace_picture(device, *prepared, settings), same.resolve());
}

} // namespace relief::vulkan::tests
