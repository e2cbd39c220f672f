#include "io/mesh/gltf_animation.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/mesh/gltf_primitive.h"

namespace relief {

namespace {

using Numbers = std::vector<double>;

/// Keys of a value of so many numbers, and where a time lies among them.
struct Track {
    std::span<const float> times, values;
    size_t width = 0;
    bool is_cubic = false, has_steps = false;

    /// Value of a key; of a cubic curve its tangents lie before (-1) and behind (1).
    double get(size_t key, size_t number, int part = 0) const {
        const size_t row = is_cubic ? 3 * key + size_t(1 + part) : key;
        return double(values[row * width + number]);
    }
    Numbers get_key(size_t key) const {
        Numbers result(width);
        for (size_t n = 0; n < width; ++n) result[n] = get(key, n);
        return result;
    }
};

/// Spherical between two quaternions, the shorter way; linear where they are nearly one.
Numbers turn(const Numbers& a, Numbers b, double t) {
    double cosine = 0;
    for (size_t k = 0; k < 4; ++k) cosine += a[k] * b[k];
    if (cosine < 0)
        for (double& part : b) part = -part;
    const double angle = std::acos(std::min(std::fabs(cosine), 1.0));
    constexpr double kSmall = 1e-6; // radians: sin is the angle there
    const double wa = angle < kSmall ? 1 - t : std::sin((1 - t) * angle) / std::sin(angle);
    const double wb = angle < kSmall ? t : std::sin(t * angle) / std::sin(angle);
    Numbers result(4);
    for (size_t k = 0; k < 4; ++k) result[k] = wa * a[k] + wb * b[k];
    return result;
}

/// Hermite's cubic of two values and slopes (appendix C.5).
double bend(const Track& track, size_t key, size_t number, double t, double length) {
    const double u = 1 - t;
    return track.get(key, number) * (1 + 2 * t) * u * u + length * track.get(key, number, 1) * t * u * u +
           track.get(key + 1, number) * t * t * (3 - 2 * t) -
           length * track.get(key + 1, number, -1) * t * t * u;
}

Numbers evaluate(const Track& track, double seconds, bool is_rotation) {
    const auto after = std::ranges::upper_bound(track.times, seconds, {}, [](float t) { return double(t); });
    if (after == track.times.begin()) return track.get_key(0);
    const auto key = size_t(after - track.times.begin()) - 1;
    if (after == track.times.end() || track.has_steps) return track.get_key(key);
    const double begin = double(track.times[key]), length = double(track.times[key + 1]) - begin;
    const double t = (seconds - begin) / length;
    const Numbers a = track.get_key(key), b = track.get_key(key + 1);
    if (is_rotation && !track.is_cubic) return turn(a, b, t);
    Numbers result(track.width);
    for (size_t n = 0; n < track.width; ++n)
        result[n] = track.is_cubic ? bend(track, key, n, t, length) : a[n] + (b[n] - a[n]) * t;
    return result;
}

/// `width` 0: as many numbers a key as there are.
Track read_track(GltfFile& file, const JsonNode& sampler, size_t width) {
    Track track;
    const auto node = sampler.find("interpolation");
    const std::string interpolation = node ? node->as_string() : "LINEAR";
    track.is_cubic = interpolation == "CUBICSPLINE", track.has_steps = interpolation == "STEP";
    if (!track.is_cubic && !track.has_steps && interpolation != "LINEAR")
        node->fail(fmt::format("there is no interpolation '{}'", interpolation), kDamagedHint);
    track.times = file.read_floats(sampler.get("input"), 1);
    track.values = file.read_floats(sampler.get("output"), width == 0 ? 1 : width);
    for (size_t k = 0; k < track.times.size(); ++k)
        if (!std::isfinite(track.times[k]) || (k > 0 && !(track.times[k] > track.times[k - 1])))
            sampler.get("input").fail("times do not rise", kDamagedHint);
    const size_t keys = track.times.size() * (track.is_cubic ? 3 : 1);
    const auto fail_count = [&](size_t values) {
        sampler.fail(fmt::format("{} values for {} keys", values, track.times.size()), kDamagedHint);
    };
    if (keys == 0 || track.values.empty() || track.values.size() % keys != 0)
        fail_count(track.values.size() / std::max<size_t>(width, 1));
    track.width = track.values.size() / keys;
    if (width != 0 && track.width != width) fail_count(track.values.size() / width);
    return track;
}

const JsonNode& find_animation(const std::vector<JsonNode>& animations, const std::string& wanted,
                               const GltfFile& file) {
    std::vector<std::string> names;
    for (const JsonNode& animation : animations) {
        const auto name = animation.find("name");
        names.push_back(name ? name->as_string() : std::string());
        if (name && names.back() == wanted) return animation;
    }
    size_t index = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [stop, error] = std::from_chars(wanted.data(), end, index);
    if (error == std::errc() && stop == end && index < animations.size()) return animations[index];
    if (animations.empty()) file.root().fail("has no animation", "leave the animation out");
    file.root().fail(fmt::format("has no animation '{}'", wanted),
                     suggest_word(wanted, std::vector<std::string_view>(names.begin(), names.end())));
}

Vec3f make_vector(const Numbers& numbers) {
    return {float(numbers[0]), float(numbers[1]), float(numbers[2])};
}

void set_pose(GltfFile& file, const JsonNode& sampler, const std::string& path, double seconds,
              GltfPose& pose) {
    const size_t width = path == "weights" ? 0 : path == "rotation" ? 4 : 3;
    const Numbers numbers = evaluate(read_track(file, sampler, width), seconds, path == "rotation");
    if (path == "translation") pose.translation = make_vector(numbers);
    if (path == "scale") pose.scale = make_vector(numbers);
    if (path == "rotation") pose.rotation = {numbers[0], numbers[1], numbers[2], numbers[3]};
    if (path == "weights") pose.weights = std::vector<float>(numbers.begin(), numbers.end());
}

} // namespace

std::map<size_t, GltfPose> read_gltf_poses(GltfFile& file, const std::string& animation, double seconds) {
    const std::vector<JsonNode> animations = file.list("animations"), nodes = file.list("nodes");
    const JsonNode& chosen = find_animation(animations, animation, file);
    const std::vector<JsonNode> samplers = chosen.get("samplers").elements();
    std::map<size_t, GltfPose> poses;
    for (const JsonNode& channel : chosen.get("channels").elements()) {
        const JsonNode target = channel.get("target");
        const auto node = target.find("node");
        const std::string path = target.get("path").as_string();
        const bool is_known =
            path == "translation" || path == "rotation" || path == "scale" || path == "weights";
        if (!node || !is_known) continue; // of an extension
        const auto index = size_t(&GltfFile::resolve(*node, nodes, "node") - nodes.data());
        set_pose(file, GltfFile::resolve(channel.get("sampler"), samplers, "sampler"), path, seconds,
                 poses[index]);
    }
    return poses;
}

} // namespace relief
