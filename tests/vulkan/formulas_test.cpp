// One source, two languages: the shared formulas give on the device what they give in C++.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "formulas/basis.h"
#include "formulas/bsdf.h"
#include "formulas/camera.h"
#include "formulas/cell_place.h"
#include "formulas/constants.h"
#include "formulas/displace.h"
#include "formulas/environment.h"
#include "formulas/environment_data.h"
#include "formulas/ggx_albedo.h"
#include "formulas/glass_bsdf.h"
#include "formulas/glass_vertex.h"
#include "formulas/layered_bsdf.h"
#include "formulas/light.h"
#include "formulas/light_source.h"
#include "formulas/light_tree.h"
#include "formulas/lobe_shares.h"
#include "formulas/local_start.h"
#include "formulas/shading_normal.h"
#include "formulas/sobol.h"
#include "formulas/surface_point.h"
#include "formulas/terminator.h"
#include "formulas/tonemap.h"
#include "formulas/warp.h"
#include "vulkan/device/commands.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/test_shaders.h"

namespace relief::scalar {
/// The table that devices always have, in place of one of layers.
inline LayerTable make_test_layers() {
    static const auto entries = [] {
        std::array<Vec2, kGgxEntryCount> table;
        for (uint i = 0; i < kGgxEntryCount; ++i) table[i] = read_ggx_table(i);
        return table;
    }();
    return {entries.data()};
}
#define FN inline
#include "vulkan/shaders/formula_cases-inl.h"
#undef FN
} // namespace relief::scalar

namespace relief::vulkan::tests {
namespace {

using scalar::FormulaInput;
using scalar::FormulaOutput;

constexpr uint32_t kInputCount = 1u << 14;
constexpr uint32_t kPartCount = 11;

std::vector<FormulaInput> make_inputs() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.0f, 0.999f);
    std::vector<FormulaInput> inputs(kInputCount);
    for (FormulaInput& input : inputs) {
        input.a = uint32_t(random());
        input.b = uint32_t(random());
        input.c = uint32_t(random());
        input.d = uint32_t(random());
        for (float& u : input.u) u = unit(random);
    }
    return inputs;
}

std::vector<FormulaOutput> run_on_device(const Device& device, const std::vector<FormulaInput>& inputs) {
    Buffer from(device, {.name = "inputs", .bytes = inputs.size() * sizeof(FormulaInput)});
    const Buffer to(device, {.name = "outputs", .bytes = inputs.size() * sizeof(FormulaOutput)});
    from.upload(inputs);
    BindingTable bindings(device);
    bindings.bind(scalar::kBindRays, from);
    bindings.bind(scalar::kBindHits, to);
    vulkan::Commands commands(device, bindings);
    for (uint32_t part = 0; part < kPartCount; ++part) {
        const Kernel kernel = make_test_kernel(device, "formulas", {64, part});
        commands.dispatch(kernel, kInputCount, kInputCount);
        commands.run();
    }
    return to.download<FormulaOutput>(inputs.size());
}

FormulaOutput run_in_cpp(const FormulaInput& input) {
    return {scalar::run_exact(input),   scalar::run_warp(input),    scalar::run_camera(input),
            scalar::run_shading(input), scalar::run_light(input),   scalar::run_tone(input),
            scalar::run_source(input),  scalar::run_surface(input), scalar::run_layers(input),
            scalar::run_glass(input),   scalar::run_facets(input)};
}

/// The float of one part in which device and C++ differ most, by |device - cpp| / (1 + |cpp|).
struct WorstFloat {
    float difference = 0;
    size_t index = 0; ///< of the part's floats
    float device = 0, cpp = 0;
};

template <class Part> WorstFloat find_worst(const Part& device, const Part& cpp) {
    static_assert(sizeof(Part) % sizeof(float) == 0);
    const auto a = std::bit_cast<std::array<float, sizeof(Part) / sizeof(float)>>(device);
    const auto b = std::bit_cast<std::array<float, sizeof(Part) / sizeof(float)>>(cpp);
    WorstFloat worst;
    for (size_t i = 0; i < a.size(); ++i) {
        const float difference = std::fabs(a[i] - b[i]) / (1.0f + std::fabs(b[i]));
        if (!(difference <= worst.difference))
            worst = {std::isnan(difference) ? INFINITY : difference, i, a[i], b[i]};
    }
    return worst;
}

/// All that a failure can be repeated from.
std::string describe(size_t index, const FormulaInput& input, const WorstFloat& worst) {
    return fmt::format("input {}: float {} is {:.9g} for {:.9g}; a b c d {} {} {} {}, u {:.9g}", index,
                       worst.index, worst.device, worst.cpp, input.a, input.b, input.c, input.d,
                       fmt::join(input.u, " "));
}

class Formulas : public GpuTest {
  protected:
    static void SetUpTestSuite() {
        inputs_ = make_inputs();
        outputs_ = run_on_device(device(), inputs_);
    }
    static void TearDownTestSuite() {
        inputs_.clear();
        outputs_.clear();
    }
    /// All results of one part lie within `bound`.
    template <class Part> void expect_close(Part FormulaOutput::*part, float bound) {
        for (size_t i = 0; i < inputs_.size(); ++i) {
            const WorstFloat worst = find_worst(outputs_[i].*part, run_in_cpp(inputs_[i]).*part);
            ASSERT_LE(worst.difference, bound) << describe(i, inputs_[i], worst);
        }
    }

    static inline std::vector<FormulaInput> inputs_;
    static inline std::vector<FormulaOutput> outputs_;
};

TEST_F(Formulas, of_integers_and_of_topology_are_equal) {
    using Words = std::array<uint32_t, sizeof(scalar::ExactResults) / sizeof(uint32_t)>;
    for (size_t i = 0; i < inputs_.size(); ++i)
        ASSERT_EQ(std::bit_cast<Words>(outputs_[i].exact),
                  std::bit_cast<Words>(scalar::run_exact(inputs_[i])))
            << "input " << i;
}

TEST_F(Formulas, of_warps_are_close) { expect_close(&FormulaOutput::warp, 1e-5f); }
TEST_F(Formulas, of_the_camera_are_close) { expect_close(&FormulaOutput::camera, 1e-4f); }
TEST_F(Formulas, of_the_bsdf_are_close) { expect_close(&FormulaOutput::shading, 2e-4f); }
TEST_F(Formulas, of_layers_are_close) { expect_close(&FormulaOutput::layers, 5e-4f); }
TEST_F(Formulas, of_glass_are_close) { expect_close(&FormulaOutput::glass, 5e-4f); }
TEST_F(Formulas, of_facets_are_close) { expect_close(&FormulaOutput::facets, 5e-4f); }
TEST_F(Formulas, of_lights_are_close) { expect_close(&FormulaOutput::light, 1e-4f); }
TEST_F(Formulas, of_tones_are_close) { expect_close(&FormulaOutput::tone, 1e-5f); }

TEST_F(Formulas, of_light_sources_are_close) { expect_close(&FormulaOutput::source, 1e-4f); }
TEST_F(Formulas, of_surface_points_are_close) { expect_close(&FormulaOutput::surface, 1e-4f); }

} // namespace
} // namespace relief::vulkan::tests
