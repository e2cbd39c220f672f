#include "io/scene/keyed_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "io/scene/scene_keys.h"
#include "relief/error.h"
#include "relief/shot.h"

namespace relief {

bool has_keys(const Json& value) {
    if (!value.is_object()) return false;
    const auto keys = value.find("keys");
    return keys != value.end() && keys->is_array();
}

namespace {

using Numbers = std::vector<double>;
using Quaternion = std::array<double, 4>; // w x y z

enum class Interpolation { linear, step, smooth };

constexpr double kMostFrames = 1e9;

/// Keys whose texts are names of files.
bool names_file(std::string_view key) {
    return key == "file" || key.ends_with("_texture") || key == "geometry_normal";
}

bool is_numbers(const Json& value) {
    return value.is_number() ||
           (value.is_array() && std::ranges::all_of(value, [](const Json& v) { return v.is_number(); }));
}

Numbers read_numbers(const Json& value) {
    if (value.is_number()) return {value.get<double>()};
    return value.get<Numbers>();
}

Json write_numbers(const Numbers& numbers, bool is_array) {
    return is_array ? Json(numbers) : Json(numbers.front());
}

/// The keys of a value, in the order of their frames.
struct Track {
    std::vector<double> frames;
    std::vector<const Json*> values;
    Interpolation interpolation = Interpolation::linear;

    size_t count() const { return frames.size(); }
    /// The last key at or before a frame; 0 before all.
    size_t find(double frame) const {
        const auto after = std::ranges::upper_bound(frames, frame);
        return after == frames.begin() ? 0 : size_t(after - frames.begin()) - 1;
    }
    bool is_between(double frame) const { return frame > frames.front() && frame < frames.back(); }
};

Interpolation read_interpolation(const JsonNode& node, bool has_numbers) {
    const auto found = node.find("interpolation");
    if (!found) return has_numbers ? Interpolation::linear : Interpolation::step;
    const std::string text = found->as_string();
    if (text == "step") return Interpolation::step;
    if (text != "linear" && text != "smooth")
        found->fail(fmt::format("there is no interpolation '{}'", text), "linear, smooth or step");
    if (!has_numbers) found->fail("only numbers have values in between", "step");
    return text == "linear" ? Interpolation::linear : Interpolation::smooth;
}

Track read_track(const Json& value, const JsonNode& node) {
    node.check_keys(scene_keys::kKeyed);
    Track track;
    const Json& keys = value.at("keys");
    const std::vector<JsonNode> nodes = node.get("keys").elements();
    if (nodes.empty()) node.get("keys").fail("there is no key", "[[frame, value], ...]");
    for (size_t k = 0; k < nodes.size(); ++k) {
        if (!keys[k].is_array() || keys[k].size() != 2) nodes[k].fail("a key is [frame, value]");
        nodes[k].elements()[0].as_float(-kMostFrames, kMostFrames); // checked as a number
        const double frame = keys[k][0].get<double>();
        if (k > 0 && !(frame > track.frames.back()))
            nodes[k].fail(fmt::format("frame {} does not come after frame {}", frame, track.frames.back()),
                          "keys stand in the order of their frames");
        const Json& at_frame = keys[k][1];
        const bool fits =
            k == 0 ||
            (at_frame.type() == track.values[0]->type() && at_frame.size() == track.values[0]->size()) ||
            (at_frame.is_number() && track.values[0]->is_number());
        if (!fits) nodes[k].fail("is of another kind than the first key's value");
        track.frames.push_back(frame), track.values.push_back(&at_frame);
    }
    track.interpolation = read_interpolation(
        node, std::ranges::all_of(track.values, [](const Json* v) { return is_numbers(*v); }));
    return track;
}

/// Slope at a key of a smooth curve: that of the line between its neighbours (Catmull and Rom 1974), 0 at the
/// ends and where the value turns back, and never so steep that the curve would leave the values beside it
/// (Fritsch and Carlson 1980).
double find_slope(const Track& track, const std::vector<double>& values, size_t k) {
    if (k == 0 || k + 1 == track.count()) return 0;
    const double before = (values[k] - values[k - 1]) / (track.frames[k] - track.frames[k - 1]);
    const double after = (values[k + 1] - values[k]) / (track.frames[k + 1] - track.frames[k]);
    if (before * after <= 0) return 0;
    const double mean = (values[k + 1] - values[k - 1]) / (track.frames[k + 1] - track.frames[k - 1]);
    const double most = 3 * std::min(std::fabs(before), std::fabs(after));
    return std::copysign(std::min(std::fabs(mean), most), mean);
}

/// Of one number over all keys; `frame` lies between two.
double interpolate(const Track& track, const std::vector<double>& values, double frame) {
    const size_t k = track.find(frame);
    const double length = track.frames[k + 1] - track.frames[k], t = (frame - track.frames[k]) / length;
    if (track.interpolation == Interpolation::linear) return values[k] + (values[k + 1] - values[k]) * t;
    const double m0 = find_slope(track, values, k) * length, m1 = find_slope(track, values, k + 1) * length;
    const double u = 1 - t;
    // Cubic Hermite form.
    return values[k] * (1 + 2 * t) * u * u + m0 * t * u * u + values[k + 1] * t * t * (3 - 2 * t) -
           m1 * t * t * u;
}

Quaternion multiply(const Quaternion& a, const Quaternion& b) {
    return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

double dot(const Quaternion& a, const Quaternion& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/// Rotation about x, then y, then z.
Quaternion make_quaternion(const Numbers& degrees) {
    Quaternion result = {1, 0, 0, 0};
    for (size_t axis = 0; axis < 3; ++axis) {
        const double half = degrees[axis] * std::numbers::pi / 360;
        Quaternion turn = {std::cos(half), 0, 0, 0};
        turn[axis + 1] = std::sin(half);
        result = multiply(turn, result);
    }
    return result;
}

/// Inverse of make_quaternion, for any length.
Numbers find_angles(const Quaternion& q) {
    const double scale = 1 / dot(q, q), w = q[0], x = q[1], y = q[2], z = q[3];
    const double sine = std::clamp(2 * (w * y - x * z) * scale, -1.0, 1.0);
    constexpr double kDegrees = 180 / std::numbers::pi;
    constexpr double kPole = 1 - 1e-12;
    // At a pole x and z turn about one axis: all of it is given to z.
    if (std::fabs(sine) > kPole)
        return {0, std::copysign(90.0, sine), std::copysign(2.0, -sine) * std::atan2(x, w) * kDegrees};
    return {std::atan2(2 * (w * x + y * z) * scale, 1 - 2 * (x * x + y * y) * scale) * kDegrees,
            std::asin(sine) * kDegrees,
            std::atan2(2 * (w * z + x * y) * scale, 1 - 2 * (y * y + z * z) * scale) * kDegrees};
}

Quaternion blend(const Quaternion& a, const Quaternion& b, double t) {
    const double cosine = std::min(dot(a, b), 1.0), angle = std::acos(cosine);
    constexpr double kSmall = 1e-6; // radians: sin is the angle there
    const double wa = angle < kSmall ? 1 - t : std::sin((1 - t) * angle) / std::sin(angle);
    const double wb = angle < kSmall ? t : std::sin(t * angle) / std::sin(angle);
    Quaternion result;
    for (size_t k = 0; k < 4; ++k) result[k] = wa * a[k] + wb * b[k];
    return result;
}

bool turns_about_one_axis(const Track& track) {
    int changing = 0;
    for (size_t axis = 0; axis < 3; ++axis)
        changing += std::ranges::any_of(
            track.values, [&](const Json* value) { return (*value)[axis] != (*track.values[0])[axis]; });
    return changing <= 1;
}

Numbers rotate(const Track& track, double frame) {
    std::vector<Quaternion> turns;
    for (const Json* value : track.values) {
        turns.push_back(make_quaternion(read_numbers(*value)));
        if (turns.size() > 1 && dot(turns[turns.size() - 2], turns.back()) < 0)
            for (double& part : turns.back()) part = -part;
    }
    const size_t k = track.find(frame);
    if (track.interpolation == Interpolation::linear) {
        const double t = (frame - track.frames[k]) / (track.frames[k + 1] - track.frames[k]);
        return find_angles(blend(turns[k], turns[k + 1], t));
    }
    Quaternion result;
    for (size_t part = 0; part < 4; ++part) {
        std::vector<double> values;
        for (const Quaternion& turn : turns) values.push_back(turn[part]);
        result[part] = interpolate(track, values, frame);
    }
    return find_angles(result);
}

Json evaluate_track(const Track& track, std::string_view key, double frame) {
    if (track.interpolation == Interpolation::step || !track.is_between(frame))
        return *track.values[track.find(frame)];
    const bool is_array = track.values[0]->is_array();
    if (key == "rotate_degrees" && is_array && track.values[0]->size() == 3 && !turns_about_one_axis(track))
        return write_numbers(rotate(track, frame), true);
    const size_t size = is_array ? track.values[0]->size() : 1;
    Numbers result;
    for (size_t n = 0; n < size; ++n) {
        std::vector<double> values;
        for (const Json* value : track.values) values.push_back(read_numbers(*value)[n]);
        result.push_back(interpolate(track, values, frame));
    }
    return write_numbers(result, is_array);
}

std::string join_path(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
}

/// The file of a displacement or mesh.
bool names_shape(std::string_view key, std::string_view path) {
    return key == "file" && (path.starts_with("displacements.") || path.starts_with("meshes."));
}

std::string name_at(const std::string& pattern, bool is_shape, const Moment& moment) {
    if (!moment.name_file || fill_frame_number(pattern, 0) == pattern)
        return fill_frame_number(pattern, moment.frame);
    return (*moment.name_file)(pattern, moment.frame, is_shape ? FileUse::shape : FileUse::other);
}

Json evaluate(const Json& value, std::string_view key, const std::string& path, const Moment& moment) {
    if (has_keys(value)) {
        const JsonNode node(value, path, moment.file);
        if (key == "matrix")
            node.fail("a matrix has no values in between that turn and keep their size",
                      "keys of translate, rotate_degrees and scale");
        return evaluate(evaluate_track(read_track(value, node), key, moment.frame), key, path, moment);
    }
    if (value.is_string() && names_file(key))
        return name_at(value.get_ref<const std::string&>(), names_shape(key, path), moment);
    if (value.is_object()) {
        Json result = Json::object();
        for (const auto& [name, member] : value.items())
            result[name] = evaluate(member, name, join_path(path, name), moment);
        return result;
    }
    if (!value.is_array()) return value;
    Json result = Json::array();
    for (size_t k = 0; k < value.size(); ++k)
        result.push_back(evaluate(value[k], key, fmt::format("{}[{}]", path, k), moment));
    return result;
}

/// Those at and around [low, high], and one more on either side, which smooth curves depend on.
Json choose_keys(const Json& keys, double low, double high) {
    const auto frame_of = [&](size_t k) { return keys[k].at(0).get<double>(); };
    size_t begin = 0, end = keys.size();
    while (begin + 2 < end && frame_of(begin + 2) <= low) ++begin;
    while (begin + 3 <= end && frame_of(end - 3) >= high) --end;
    Json result = Json::array();
    for (size_t k = begin; k < end; ++k) result.push_back(keys[k]);
    return result;
}

} // namespace

bool depends_on_frame(const Json& value, std::string_view key) {
    if (has_keys(value)) return true;
    if (value.is_string() && names_file(key)) {
        const std::string& name = value.get_ref<const std::string&>();
        return fill_frame_number(name, 0) != name;
    }
    if (value.is_object()) {
        for (const auto& [name, member] : value.items())
            if (depends_on_frame(member, name)) return true;
        return false;
    }
    return value.is_array() &&
           std::ranges::any_of(value, [&](const Json& element) { return depends_on_frame(element, key); });
}

bool is_animated(const Json& document) { return depends_on_frame(document, ""); }

void check_frame(double frame) {
    if (std::fabs(frame) > kMaxFrame || std::isnan(frame))
        throw Error(ErrorKind::usage, {fmt::format("{} is no frame", frame), "frame",
                                       fmt::format("from -{} to {}", kMaxFrame, kMaxFrame)});
}

Json evaluate_frame(const Json& document, double frame, const std::string& file) {
    return evaluate_value(document, "", {frame, file});
}

Json evaluate_value(const Json& value, const std::string& path, const Moment& moment) {
    const size_t dot = path.rfind('.');
    const std::string key = path.ends_with(']') ? "" : dot == std::string::npos ? path : path.substr(dot + 1);
    return evaluate(value, key, path, moment);
}

Json trim_keys(const Json& value, double low, double high) {
    Json result = value;
    if (has_keys(value))
        result["keys"] = choose_keys(value["keys"], low, high);
    else if (value.is_structured())
        for (Json& member : result) member = trim_keys(member, low, high);
    return result;
}

std::string fill_frame_number(const std::string& name, double frame) {
    std::string result;
    for (size_t k = 0; k < name.size();) {
        const size_t end = std::min(name.find_first_not_of('#', k), name.size());
        if (end - k >= 2) {
            result += fmt::format("{:0{}}", int64_t(std::floor(frame)), end - k);
            k = end;
        } else {
            result += name[k++];
        }
    }
    return result;
}

std::vector<std::string> list_file_names(const Json& document) {
    std::vector<std::string> names;
    const auto visit = [&](const auto& self, const Json& value, std::string_view key) -> void {
        if (value.is_string() && names_file(key)) names.push_back(value.get<std::string>());
        if (value.is_object())
            for (const auto& [name, member] : value.items()) self(self, member, name);
        if (value.is_array())
            for (const Json& element : value) self(self, element, key);
    };
    visit(visit, document, "");
    return names;
}

} // namespace relief
