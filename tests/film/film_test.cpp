#include "film/film.h"

#include <bit>
#include <cmath>
#include <memory>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>

#include "math/vec.h"
#include "relief/error.h"
#include "support/all_layers.h"

namespace relief {
namespace {

const std::vector<std::string> kAllLayers = test::list_all_layers("light_key");

/// Instance k is object 101 + k, of one of three materials.
std::shared_ptr<const InstanceMattes> make_mattes() {
    auto mattes = std::make_shared<InstanceMattes>();
    for (uint32_t k = 0; k < 100; ++k)
        mattes->objects.push_back(101 + k), mattes->materials.push_back(11 + k % 3);
    mattes->entries["cryptomatte/3ae39a5/name"] = "CryptoObject";
    return mattes;
}

Film make_whole_film(int width, int height, const Window& window = {}) {
    Film film(width, height, window, kAllLayers);
    film.name_instances(make_mattes());
    return film;
}

FilmSample make_hit(float radiance, float depth, uint32_t id) {
    FilmSample hit;
    hit.radiance = {radiance, 2 * radiance, 3 * radiance};
    hit.alpha = 1;
    hit.depth = depth;
    hit.shading_normal = {0, 0, 1};
    hit.geometric_normal = {0, 1, 0};
    hit.position = {depth, 5, 6};
    hit.albedo = {0.5f, 0.25f, 1};
    hit.uv = {0.25f, 0.75f};
    hit.id = id;
    hit.cost = 3;
    return hit;
}

float value(const Image& image, int x, int y, const char* channel) {
    return image.at(x, y, image.find_channel(channel).value());
}

TEST(Film, names_its_channels_in_the_order_of_its_table) {
    const Film film(4, 4, {}, {"cost", "depth", "id", "uv"});
    const std::vector<std::string> expected{"R", "G", "B", "A", "depth.Z", "uv.X", "uv.Y", "id.I", "cost.Y"};
    EXPECT_EQ(film.resolve().channels, expected);
}

TEST(Film, needs_sums_of_surfaces_for_layers_of_surfaces_alone) {
    const auto needs = [](const std::vector<std::string>& layers) {
        return Film(4, 4, {}, layers).needs_surface_sums();
    };
    for (const char* layer : {"depth", "N", "N_camera", "Ng", "P", "albedo", "uv", "id", "shadow"})
        EXPECT_TRUE(needs({layer})) << layer;
    EXPECT_FALSE(needs({}));
    EXPECT_FALSE(needs({"samples", "variance", "cost", "direct", "light_GROUP"}));
    EXPECT_TRUE(needs({"variance", "albedo"}));
    EXPECT_FALSE(Film(4, 4, {}, {}, ErrorEstimate::on).needs_surface_sums());
}

TEST(Film, refuses_an_unknown_layer_and_lists_the_known_ones) {
    try {
        const Film film(4, 4, {}, {"dept"});
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find("depth, N, N_camera, Ng"), std::string::npos);
    }
}

TEST(Film, refuses_a_picture_that_memory_cannot_hold_and_says_what_it_needs) {
    try {
        const Film film(1 << 25, 1 << 25, {}, {});
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        EXPECT_NE(std::string(error.what()).find("72057594037927936 bytes"), std::string::npos)
            << error.what();
    }
    EXPECT_NO_THROW(Film(1 << 25, 1 << 25, {0, 0, 8, 8}, {}));
}

TEST(Film, counts_what_it_takes_to_find_motions_as_memory_of_their_layer) {
    try {
        const Film film(1 << 25, 1 << 25, {}, {"motion"});
        FAIL() << "accepted";
    } catch (const Error& error) {
        const std::string bytes = std::to_string((uint64_t(1) << 50) * (64 + 8 + 32));
        EXPECT_NE(std::string(error.what()).find(bytes + " bytes"), std::string::npos) << error.what();
    }
}

TEST(Film, averages_colour_and_describes_the_nearest_hit) {
    Film film = make_whole_film(8, 6, {2, 1, 6, 5});
    film.add_sample(3, 2, make_hit(1, 10, 7));
    film.add_sample(3, 2, make_hit(3, 4, 9));
    film.add_sample(3, 2, FilmSample{});
    film.add_sample(3, 2, make_hit(4, 4, 8));
    const Image image = film.resolve();
    EXPECT_EQ(image.x0, 2);
    EXPECT_EQ(image.y0, 1);
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.full_width, 8);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "R"), 2);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "B"), 6);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "A"), 0.75f);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "depth.Z"), 4);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "id.I"), 8);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "N.Z"), 1);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "Ng.Y"), 1);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "P.X"), 6);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "uv.Y"), 0.75f);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "albedo.R"), 0.375f);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "samples.Y"), 4);
    EXPECT_FLOAT_EQ(value(image, 3, 2, "cost.Y"), 2.25f);
}

TEST(Film, gives_the_unbiased_variance_of_the_mean) {
    Film film(1, 1, {}, {"variance"});
    for (float radiance : {1.0f, 2.0f, 4.0f}) film.add_sample(0, 0, make_hit(radiance, 1, 1));
    // Deviations from 7/3: 16/9 + 1/9 + 25/9 = 42/9; over (n - 1) n = 6.
    EXPECT_NEAR(value(film.resolve(), 0, 0, "variance.R"), 42.0 / 54.0, 1e-6);
    EXPECT_NEAR(value(film.resolve(), 0, 0, "variance.G"), 4 * 42.0 / 54.0, 1e-5);
}

TEST(Film, leaves_untouched_pixels_black_and_infinitely_far) {
    const Image image = make_whole_film(3, 2).resolve();
    EXPECT_EQ(image.width, 3);
    for (size_t c = 0; c < image.channels.size(); ++c) {
        if (image.channels[c] == "depth.Z")
            EXPECT_TRUE(std::isinf(image.at(1, 1, c)));
        else
            EXPECT_EQ(image.at(1, 1, c), 0) << image.channels[c];
    }
}

TEST(Film, keeps_small_contributions_beside_large_sums) {
    Film film(1, 1, {}, {});
    film.add_sample(0, 0, make_hit(1e8f, 1, 1));
    for (int k = 0; k < 1000; ++k) film.add_sample(0, 0, make_hit(1, 1, 1));
    EXPECT_FLOAT_EQ(value(film.resolve(), 0, 0, "R"), float((1e8 + 1000) / 1001));
}

Vec3<double> square(const Vec3f& v) { return {double(v.x) * v.x, double(v.y) * v.y, double(v.z) * v.z}; }

TEST(Film, takes_sums_of_samples_like_the_samples_themselves) {
    Film one_by_one = make_whole_film(2, 1), summed = make_whole_film(2, 1);
    const std::vector<uint32_t> hit_ids{7, 9, 8};
    const FilmSample hits[3] = {make_hit(1, 10, 7), make_hit(3, 4, 9), make_hit(4, 4, 8)};
    FilmSums sums;
    for (const FilmSample& hit : hits) {
        one_by_one.add_sample(1, 0, hit);
        ++sums.count, ++sums.hit_count;
        sums.radiance += hit.radiance, sums.squares += square(hit.radiance);
        sums.cost += hit.cost;
        sums.shading_normal += hit.shading_normal, sums.geometric_normal += hit.geometric_normal;
        sums.position += hit.position, sums.albedo += hit.albedo;
        sums.uv = sums.uv + hit.uv;
    }
    FilmSample caught;
    caught.shadow = {1, 0.5f, 2};
    one_by_one.add_sample(1, 0, caught);
    ++sums.count, sums.shadow += caught.shadow;
    sums.depth = 4, sums.id = 8, sums.hit_ids = hit_ids;
    FilmSample miss;
    miss.radiance = {0.5f, 0, 2}, miss.cost = 1;
    one_by_one.add_sample(1, 0, miss);
    summed.add_sums(1, 0, sums);
    FilmSums missed;
    missed.count = 1;
    missed.radiance = miss.radiance, missed.squares = square(miss.radiance), missed.cost = miss.cost;
    summed.add_sums(1, 0, missed);
    miss.alpha = 1; // a light that the camera sees
    one_by_one.add_sample(1, 0, miss);
    missed.light_count = 1;
    summed.add_sums(1, 0, missed);
    const Image image = summed.resolve();
    EXPECT_FLOAT_EQ(image.at(1, 0, image.find_channel("A").value()), 4.75f / 6);
    EXPECT_EQ(summed.resolve().pixels, one_by_one.resolve().pixels);
}

TEST(Film, finds_the_alpha_of_shadows_from_sums_of_light) {
    Film film(2, 1, {}, {"shadow"});
    FilmSample miss, caught;
    film.add_sample(0, 0, make_hit(1, 1, 1)), film.add_sample(0, 0, miss);
    for (const Vec3f& shadow : {Vec3f{1, 0, 6}, Vec3f{1, 3, 3}, Vec3f{1, 0, 0}}) { // 1/3 of the light arrives
        caught.shadow = shadow;
        film.add_sample(0, 0, caught);
    }
    caught.shadow = {1, 0, 0};
    film.add_sample(1, 0, caught);
    const Image image = film.resolve();
    EXPECT_FLOAT_EQ(value(image, 0, 0, "A"), (1 + 3 * 2 / 3.0f) / 5);
    EXPECT_FLOAT_EQ(value(image, 0, 0, "shadow.C"), 3 / 5.0f);
    EXPECT_FLOAT_EQ(value(image, 0, 0, "shadow.L"), 3 / 5.0f);
    EXPECT_FLOAT_EQ(value(image, 0, 0, "shadow.U"), 9 / 5.0f);
    EXPECT_EQ(value(image, 1, 0, "A"), 0) << "no light, no shadow";
}

/// Ids and samples, of 1024, of the ranks of pixel (0, 0).
std::vector<std::pair<uint32_t, int>> get_ranks(const Image& image, const std::string& layer) {
    std::vector<std::pair<uint32_t, int>> ranks;
    const size_t first = image.find_channel(layer + "00.r").value();
    for (size_t k = first; k < first + 12; k += 2)
        if (image.pixels[k] != 0)
            ranks.emplace_back(std::bit_cast<uint32_t>(image.pixels[k]),
                               int(std::lround(1024 * double(image.pixels[k + 1]))));
    return ranks;
}

void add_hits(Film& film, uint32_t id, int count) {
    for (int k = 0; k < count; ++k) film.add_sample(0, 0, make_hit(1, 1, id));
}

using Ranks = std::vector<std::pair<uint32_t, int>>;

TEST(Film, ranks_mattes_by_their_share_of_the_samples) {
    Film film = make_whole_film(1, 1);
    add_hits(film, 3, 100), add_hits(film, 1, 300), add_hits(film, 4, 200);
    for (int k = 0; k < 424; ++k) film.add_sample(0, 0, FilmSample{});
    const Image image = film.resolve();
    EXPECT_EQ(get_ranks(image, "CryptoObject"), (Ranks{{101, 300}, {104, 200}, {103, 100}}));
    EXPECT_EQ(get_ranks(image, "CryptoMaterial"), (Ranks{{11, 500}, {13, 100}})) << "1 and 4 share one";
    EXPECT_EQ(image.metadata.at("cryptomatte/3ae39a5/name"), "CryptoObject");
    film.clear({0, 0, 1, 1});
    EXPECT_TRUE(get_ranks(film.resolve(), "CryptoObject").empty());
}

TEST(Film, keeps_mattes_exactly_while_there_are_no_more_than_slots) {
    Film film = make_whole_film(1, 1);
    for (uint32_t id = 1; id <= 8; ++id) add_hits(film, id, int(id));
    add_hits(film, 1, 988);
    EXPECT_EQ(get_ranks(film.resolve(), "CryptoObject"),
              (Ranks{{101, 989}, {108, 8}, {107, 7}, {106, 6}, {105, 5}, {104, 4}}));
}

TEST(Film, never_loses_a_matte_with_a_large_share) {
    Film film(1, 1, {}, {"CryptoObject"});
    film.name_instances(make_mattes());
    for (int k = 0; k < 1024; ++k) // 50 is one in five, behind 49 others
        add_hits(film, k % 5 == 4 ? 50 : 1 + uint32_t(k * 11 % 49), 1);
    const Ranks ranks = get_ranks(film.resolve(), "CryptoObject");
    EXPECT_EQ(ranks.front().first, 150u);
    EXPECT_GE(ranks.front().second, 204) << "what it has";
    EXPECT_LE(ranks.front().second, 204 + 1024 / 8) << "and at most what its slot had before";
    int sum = 0;
    for (const auto& [id, samples] : ranks) sum += samples;
    EXPECT_LE(sum, 1024);
    EXPECT_GE(sum, 1024 * 3 / 4) << "two of eight slots are beyond the ranks";
}

TEST(Film, goes_on_with_mattes_from_its_bytes) {
    Film whole = make_whole_film(1, 1), first = make_whole_film(1, 1), second = make_whole_film(1, 1);
    const auto add = [](Film& film, int begin, int end) {
        for (int k = begin; k < end; ++k) add_hits(film, 1 + uint32_t(k * 13 % 31), 1);
    };
    add(whole, 0, 200), add(first, 0, 77);
    std::stringstream bytes;
    first.write(bytes, "a picture");
    second.read(bytes, "a picture");
    add(second, 77, 200);
    EXPECT_EQ(second.resolve().pixels, whole.resolve().pixels);
    std::stringstream again(bytes.str());
    Film other(1, 1, {}, {"CryptoObject"});
    EXPECT_THROW(other.read(again, "a picture"), Error);
}

TEST(Film, has_a_layer_for_each_kind_and_group_of_light_that_is_asked_for) {
    Film film(2, 1, {}, {"light_rim", "emission", "light_key", "diffuse_indirect", "depth"});
    EXPECT_EQ(film.light_layers().count(), 10u);
    for (int k = 1; k <= 2; ++k) {
        film.add_sample(1, 0, make_hit(1, 1, 1));
        std::vector<Vec3f> lights; // eight kinds, key, rim
        for (int n = 0; n < 10; ++n) lights.push_back({float(k), float(n), 0.5f});
        film.add_lights(1, 0, lights);
    }
    const Image image = film.resolve();
    const std::vector<std::string> expected{"R",
                                            "G",
                                            "B",
                                            "A",
                                            "depth.Z",
                                            "diffuse_indirect.R",
                                            "diffuse_indirect.G",
                                            "diffuse_indirect.B",
                                            "emission.R",
                                            "emission.G",
                                            "emission.B",
                                            "light_key.R",
                                            "light_key.G",
                                            "light_key.B",
                                            "light_rim.R",
                                            "light_rim.G",
                                            "light_rim.B"};
    EXPECT_EQ(image.channels, expected);
    for (const auto& [layer, n] :
         {std::pair{"diffuse_indirect", 1}, {"emission", 6}, {"light_key", 8}, {"light_rim", 9}}) {
        EXPECT_EQ(value(image, 1, 0, (layer + std::string(".R")).c_str()), 1.5f) << layer;
        EXPECT_EQ(value(image, 1, 0, (layer + std::string(".G")).c_str()), float(n)) << layer;
        EXPECT_EQ(value(image, 0, 0, (layer + std::string(".B")).c_str()), 0) << layer;
    }
}

TEST(Film, turns_normals_into_the_space_of_the_camera) {
    Film film(1, 1, {}, {"N", "N_camera"});
    film.add_sample(0, 0, make_hit(1, 1, 1)); // along z
    const Image image = film.resolve({{}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(value(image, 0, 0, "N.Z"), 1);
    EXPECT_EQ(value(image, 0, 0, "N_camera.X"), 1);
    EXPECT_EQ(value(image, 0, 0, "N_camera.Z"), 0);
}

TEST(Film, counts_its_bytes) {
    EXPECT_EQ(Film(10, 10, {}, {"CryptoObject"}).byte_count(), 100 * (4 * sizeof(double) + 4 + 64));
    EXPECT_EQ(Film(10, 10, {}, {}).byte_count(), 100 * (4 * sizeof(double) + 4));
    EXPECT_GT(Film(10, 10, {}, kAllLayers).byte_count(), Film(10, 10, {}, {}).byte_count());
}

} // namespace
} // namespace relief
