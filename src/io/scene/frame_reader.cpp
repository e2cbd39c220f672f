#include "io/scene/frame_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/content_hash.h"
#include "io/scene/scene_sections.h"
#include "relief/error.h"

namespace relief {

namespace {

/// `render.frames`; empty: the file names none.
std::vector<int> read_frames(const Json& document, const std::string& name) {
    const auto render = JsonNode(document, "", name).find("render");
    const auto frames = render ? render->find("frames") : std::nullopt;
    return frames ? parse_frames_at(*frames) : std::vector<int>();
}

bool has_shutter(const Json& document) {
    const auto camera = document.find("camera");
    return camera != document.end() && camera->is_object() && camera->contains("shutter");
}

bool is_open(const Camera& camera) { return camera.shutter_open < camera.shutter_close; }

/// Times between which nothing but values with keys and blends of two files change: both ends of the
/// shutter, and the whole frames between them. It closes just before its end.
std::vector<double> list_times(double frame, const Camera& camera) {
    if (!is_open(camera)) return {frame + double(camera.shutter_open)};
    const double first = frame + double(camera.shutter_open);
    const double last = std::nextafter(frame + double(camera.shutter_close), first);
    std::vector<double> times = {first};
    for (double whole = std::floor(first) + 1; whole < last; ++whole) times.push_back(whole);
    times.push_back(last);
    return times;
}

} // namespace

FrameReader::FrameReader(Json document, std::string name, AssetCache assets, const MeshReaderSettings& reader)
    : document_(std::move(document)),
      name_(std::move(name)),
      reader_(reader),
      assets_(std::move(assets)),
      sequences_(assets_.folder()),
      frames_(read_frames(document_, name_)),
      is_animated_(relief::is_animated(document_)),
      has_moving_sections_(relief::has_moving_sections(document_)),
      moving_(list_moving_parts(document_)) {
    assets_.keep_meshes(has_shutter(document_));
}

void FrameReader::take_over_pictures(FrameReader& before, SceneAssets given) {
    assets_ = std::move(before.assets_);
    assets_.change_given(std::move(given));
    assets_.keep_meshes(has_shutter(document_));
}

FrameReader::Ends FrameReader::choose_ends(double frame) {
    return frame == std::floor(frame) ? Ends::strict : Ends::held;
}

SequenceFiles FrameReader::find_files(const std::string& pattern, double frame, FileUse use, Ends ends) {
    if (ends == Ends::held)
        return use == FileUse::shape ? sequences_.find_beside(pattern, frame)
                                     : sequences_.find_whole(pattern, frame);
    SequenceFiles files;
    files.first = fill_frame_number(pattern, frame);
    files.first_number = int64_t(std::floor(frame));
    return files;
}

NameFile FrameReader::make_namer(Ends ends) {
    return [this, ends](const std::string& pattern, double frame, FileUse use) {
        const SequenceFiles files = find_files(pattern, frame, use, ends);
        assets_.add_sequence(files);
        return name_blend(files);
    };
}

std::vector<Json> FrameReader::evaluate_parts(double frame, Ends ends) {
    assets_.set_frame(int64_t(std::floor(frame)));
    const NameFile name_file = make_namer(ends);
    std::vector<Json> parts;
    for (const ScenePart& part : moving_)
        parts.push_back(evaluate_value(*part.value, part.path, {frame, name_, &name_file}));
    return parts;
}

Scene FrameReader::load(double frame) {
    check_frame(frame);
    return load_at(frame, choose_ends(frame));
}

Scene FrameReader::load_at(double frame, Ends ends) {
    sequences_.refresh();
    assets_.begin();
    if (!is_animated_) return load_still();
    State next{SceneReader(name_, reader_), evaluate_parts(frame, ends), {}, 0};
    const NameFile name_file = make_namer(ends);
    const Json document = evaluate_value(document_, "", {frame, name_, &name_file});
    next.reader.read(document, assets_);
    next.document_hash = hash_document(document);
    for (size_t k = 0; k < moving_.size(); ++k)
        next.part_hashes.push_back(hash_part(moving_[k].path, next.parts[k]));
    const uint64_t hash = hash_now(next);
    Scene scene = next.reader.take_scene();
    scene.hash = hash_shutter(next, hash, frame);
    state_ = std::move(next);
    forget(scene.camera, frame);
    return scene;
}

/// Of a large scene a copy takes time and memory: none is made where all frames have one.
Scene FrameReader::load_still() {
    SceneReader reader(name_, reader_);
    reader.read(document_, assets_);
    const uint64_t hash = join_hashes(hash_document(document_), reader.hash_content());
    Scene scene = std::move(reader.scene());
    scene.hash = hash;
    still_ = Shot::View{scene.camera, scene.hash};
    return scene;
}

void FrameReader::move(State& state, std::vector<Json> parts) {
    for (size_t k = 0; k < moving_.size(); ++k) {
        if (parts[k] == state.parts[k]) continue;
        state.reader.read_part(moving_[k], parts[k], assets_);
        const uint64_t hash = hash_part(moving_[k].path, parts[k]);
        state.document_hash += hash - state.part_hashes[k];
        state.part_hashes[k] = hash;
    }
    state.parts = std::move(parts);
}

uint64_t FrameReader::hash_now(State& state) {
    return join_hashes(state.document_hash, state.reader.hash_content());
}

/// Of the frame with all that its shutter sees: the scene where list_times() says, and the keys that lead
/// from one to the next. `hash` is that of the scene at the frame.
uint64_t FrameReader::hash_shutter(const State& state, uint64_t hash, double frame) {
    const Camera& camera = state.reader.scene().camera;
    if (!is_open(camera) || frame != std::floor(frame)) return hash;
    State scout = state;
    const std::vector<double> times = list_times(frame, camera);
    std::vector<uint64_t> hashes = {hash};
    for (const double time : times) {
        move(scout, evaluate_parts(time, Ends::held));
        hashes.push_back(hash_now(scout));
    }
    ContentHash all;
    all.add(hashes);
    for (const ScenePart& part : moving_)
        all.add(nlohmann::json(trim_keys(*part.value, times.front(), times.back())).dump());
    assets_.drop_warnings();
    return all.value();
}

bool FrameReader::is_view(const State& state, const std::vector<Json>& parts) const {
    for (size_t k = 0; k < moving_.size(); ++k)
        if (moving_[k].section != "camera" && parts[k] != state.parts[k]) return false;
    return true;
}

SceneUpdate FrameReader::update(double frame) {
    check_frame(frame);
    if (still_) return {std::nullopt, still_->camera, still_->scene_hash};
    if (!state_ || has_moving_sections_) {
        SceneUpdate result;
        result.scene = load_at(frame, Ends::held);
        result.camera = result.scene->camera, result.scene_hash = result.scene->hash;
        return result;
    }
    State state = *std::exchange(state_, std::nullopt); // is back when all has been read
    std::vector<Json> parts = evaluate_parts(frame, Ends::held);
    const bool is_same_scene = is_view(state, parts);
    move(state, std::move(parts));
    SceneUpdate result;
    result.camera = state.reader.scene().camera;
    const uint64_t hash = hash_now(state);
    if (!is_same_scene) result.scene = state.reader.take_scene();
    std::vector<std::string> warnings = std::move(assets_.warnings());
    assets_.warnings().clear();
    result.scene_hash = hash_shutter(state, hash, frame);
    if (result.scene) {
        result.scene->hash = result.scene_hash;
        for (std::string& warning : warnings) result.scene->warnings.push_back(std::move(warning));
    }
    state_ = std::move(state);
    forget(result.camera, frame);
    return result;
}

std::optional<Shot::View> FrameReader::find_view(double frame) {
    check_frame(frame);
    if (still_ || !state_ || has_moving_sections_) return still_;
    std::vector<Json> parts = evaluate_parts(frame, choose_ends(frame));
    if (!is_view(*state_, parts)) return std::nullopt;
    State state = *state_;
    move(state, std::move(parts));
    const uint64_t hash = hash_now(state);
    return Shot::View{state.reader.scene().camera, hash_shutter(state, hash, frame)};
}

/// Two times of one shutter lie no farther apart than it is open.
void FrameReader::forget(const Camera& camera, double frame) {
    const auto open = double(camera.shutter_open), close = double(camera.shutter_close);
    const double length = close - open;
    assets_.forget(int64_t(std::floor(frame + std::min(open, -length))),
                   int64_t(std::ceil(frame + std::max(close, length))));
}

std::vector<std::string> FrameReader::list_names(double frame) {
    check_frame(frame);
    if (!is_animated_) return list_file_names(document_);
    std::vector<std::string> names;
    const auto add = [&](const std::vector<std::string>& more) {
        for (const std::string& name : more)
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    };
    std::vector<std::string> seconds;
    const auto evaluate = [&](const Json& value, const std::string& path, double time, Ends ends) {
        const NameFile name_file = [&](const std::string& pattern, double at, FileUse use) {
            const SequenceFiles files = find_files(pattern, at, use, ends);
            if (!files.second.empty()) seconds.push_back(files.second);
            return files.first;
        };
        return evaluate_value(value, path, {time, name_, &name_file});
    };
    const Json document = evaluate(document_, "", frame, choose_ends(frame));
    add(list_file_names(document));
    Camera camera;
    if (const auto node = JsonNode(document, "", name_).find("camera")) camera = read_camera(*node);
    if (is_open(camera))
        for (const double time : list_times(frame, camera))
            for (const ScenePart& part : moving_)
                add(list_file_names(evaluate(*part.value, part.path, time, Ends::held)));
    add(seconds);
    return names;
}

} // namespace relief
