// Choice among a thousand lights: that its densities are right, and that it pays.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cpu/shading/light_choice.h"
#include "formulas/warp.h"
#include "prepare/light_sources.h"
#include "prepare/prepared_scene.h"
#include "support/many_lights.h"
#include "support/z_test.h"

namespace relief::cpu {
namespace {

constexpr size_t kLightCount = 1000;

class ManyLights : public testing::Test {
  protected:
    ManyLights()
        : prepared_(prepare_scene(make_hall(kLightCount), {})),
          choice_(make_light_tables(*prepared_, 0.02f, make_emitter_table(*prepared_))) {}

    float next() { return unit_(random_); }
    /// On the floor or on a wall, near lights and away from them.
    scalar::LitPoint next_point() {
        const float x = next(), y = next();
        const Vec3f direction = scalar::square_to_sphere({next(), next()});
        const Vec3f normals[] = {{0, 1, 0}, {0, 0, 1}, normalize(direction)};
        return {{16 * x - 8, 3 * next() * next(), 16 * y - 8}, normals[++point_count_ % 3], 0};
    }

    std::shared_ptr<const PreparedScene> prepared_;
    LightChoice choice_;
    std::mt19937 random_{11};
    std::uniform_real_distribution<float> unit_{0, std::nextafter(1.0f, 0.0f)};
    int point_count_ = 0;
};

TEST_F(ManyLights, are_drawn_as_often_as_their_probability_says) {
    ASSERT_TRUE(choice_.has_tree());
    constexpr int count = 1 << 17;
    for (int n = 0; n < 6; ++n) {
        const scalar::LitPoint at = next_point();
        std::map<std::pair<const void*, uint32_t>, std::pair<int, float>> found;
        for (int k = 0; k < count; ++k) {
            const LightChoice::Pick pick = choice_.pick(at, (float(k) + next()) / float(count), next());
            if (!(pick.probability > 0)) continue;
            auto& [drawn, probability] = found[{pick.source, pick.emitter}];
            if (++drawn == 1) probability = pick.probability;
            ASSERT_EQ(pick.probability, probability) << "at each draw the same";
        }
        double sum = 0;
        for (const auto& [light, drawn] : found) {
            const double expected = double(drawn.second) * count;
            sum += double(drawn.second);
            EXPECT_NEAR(drawn.first, expected, 2 + 6 * std::sqrt(expected));
        }
        EXPECT_LE(sum, 1 + 1e-4);
        EXPECT_GT(sum, 0.85) << "but for lights too dim to be drawn, and dead ends";
        EXPECT_GT(found.size(), 50u);
    }
}

TEST_F(ManyLights, are_met_with_the_probability_that_they_are_drawn_with) {
    int met = 0, emitters = 0;
    for (int n = 0; n < 4000; ++n) {
        const scalar::LitPoint at = next_point();
        const LightChoice::Pick pick = choice_.pick(at, next(), next());
        if (pick.emitter != kNoIndex) {
            EXPECT_EQ(choice_.find_emitter_probability(at, pick.emitter), pick.probability);
            ++emitters;
        }
        if (!pick.source || pick.source->kind == scalar::kSourceEnvironment) continue;
        const scalar::LightDraw drawn =
            scalar::draw_listed_light(*pick.source, at.position, {next(), next()});
        if (!(drawn.pdf > 0) || drawn.pdf == scalar::make_infinity()) continue;
        int visits = 0;
        choice_.visit_met(at, choice_.find_shares(at), drawn.direction, scalar::make_infinity(),
                          [&](const scalar::LightSourceData& source, const auto& find_probability) {
                              if (&source != pick.source) return;
                              ++visits;
                              EXPECT_EQ(find_probability(), pick.probability);
                          });
        EXPECT_EQ(visits, 1);
        ++met;
    }
    EXPECT_GT(met, 1000);
    EXPECT_GT(emitters, 10);
}

/// Mean and variance of what single draws bring a white surface, without shadows.
struct Estimate {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double value) { sum += value, squares += value * value, ++count; }
    double mean() const { return sum / count; }
    double variance() const { return squares / count - mean() * mean(); }
};

double find_irradiance(const scalar::LitPoint& at, const scalar::LightDraw& drawn) {
    return drawn.pdf > 0 ? double(drawn.weight.x * std::max(dot(drawn.direction, at.normal), 0.0f)) : 0.0;
}

TEST_F(ManyLights, give_the_light_of_uniform_choice_with_far_less_noise) {
    EmitterTable none;
    none.cumulative.assign(1, 0.0);
    LightTables tables = make_light_tables(*prepared_, 0, none);
    const LightChoice tree(tables);
    tables.nodes.clear(), tables.listed_count = kLightCount;
    const LightChoice list(tables); // a thousand estimates a draw
    const auto estimate_with = [&](const LightChoice& choice, const scalar::LitPoint& at) {
        const LightChoice::Pick pick = choice.pick(at, next(), next());
        const Vec2f u{next(), next()};
        if (!pick.source) return 0.0;
        return find_irradiance(at, scalar::draw_listed_light(*pick.source, at.position, u)) /
               double(pick.probability);
    };
    double worst = 0, noise[3] = {};
    for (int n = 0; n < 48; ++n) {
        const scalar::LitPoint at = next_point();
        Estimate of_uniform, of_tree, of_list;
        for (int k = 0; k < 4000; ++k) {
            const size_t index = std::min(size_t(next() * kLightCount), kLightCount - 1);
            const scalar::LightDraw drawn =
                scalar::draw_listed_light(tables.sources[index], at.position, {next(), next()});
            of_uniform.add(find_irradiance(at, drawn) * kLightCount);
            of_tree.add(estimate_with(tree, at));
            if (k % 8 == 0) of_list.add(estimate_with(list, at));
        }
        const double error = std::sqrt((of_uniform.variance() + of_tree.variance()) / of_tree.count);
        if (!(error > 0)) continue;
        worst = std::max(worst, std::fabs(of_uniform.mean() - of_tree.mean()) / error);
        const double brightness = of_tree.mean() * of_tree.mean();
        noise[0] += of_uniform.variance() / brightness;
        noise[1] += of_tree.variance() / brightness;
        noise[2] += of_list.variance() / brightness;
    }
    // 48 points: chance of a false alarm 1e-3 at 4.2 standard errors of normal sums, which these are not
    // quite.
    EXPECT_LT(worst, 5);
    RecordProperty("variances_over_that_of_the_tree",
                   std::to_string(noise[0] / noise[1]) + " " + std::to_string(noise[2] / noise[1]));
    EXPECT_GT(noise[0] / noise[1], 10);
    EXPECT_GT(noise[2] / noise[1], 0.3) << "a list is hardly better";
}

/// The hall under some of its lights; emissive bodies glow with the first of them.
Image render_part(size_t first, size_t count, int spp) {
    Scene scene = make_hall(kLightCount);
    scene.lights = {scene.lights.begin() + long(first), scene.lights.begin() + long(first + count)};
    if (first > 0)
        for (Material& material : scene.materials) material.emission = {};
    RenderSettings settings = make_small_settings(16, spp, 2);
    settings.image.seed = uint32_t(first + count);
    return render(std::move(scene), settings).image;
}

TEST(ManyLightsPicture, is_the_sum_of_pictures_of_few_lights) {
    const std::vector<BlockMean> whole = compute_block_means(render_part(0, kLightCount, 256), 4);
    std::vector<BlockMean> sum(16);
    for (size_t first = 0; first < kLightCount; first += 25) {
        const std::vector<BlockMean> part = compute_block_means(render_part(first, 25, 64), 4);
        for (size_t k = 0; k < sum.size(); ++k)
            sum[k].mean += part[k].mean, sum[k].variance += part[k].variance;
    }
    EXPECT_LT(compute_largest_z(whole, sum), 4.5) << print_block_means(whole) << '\n'
                                                  << print_block_means(sum);
    size_t noisy = 0; // few: the comparison tells differences of a tenth
    for (size_t k = 0; k < sum.size(); ++k)
        noisy += std::sqrt(whole[k].variance + sum[k].variance) < 0.1 * sum[k].mean ? 0 : 1;
    EXPECT_LE(noisy, 2u) << print_block_means(whole) << '\n' << print_block_means(sum);
}

} // namespace
} // namespace relief::cpu
