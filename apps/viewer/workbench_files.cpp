// Workbench: files that are opened, dropped, watched and written.
#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "common/inputs.h"
#include "common/mesh_reader.h"
#include "common/values.h"
#include "common/whole_names.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/shot.h"
#include "viewer/conventions.h"
#include "viewer/workbench.h"

namespace relief::viewer {

namespace {

/// Stays within one tile, and keeps the sizes of maps.
MapEdit make_whole_edit(const Displacement& map, int udim, const Texture& texels) {
    MapEdit edit;
    edit.displacement = map.name;
    edit.udim = udim;
    edit.texels = texels;
    return edit;
}

/// Of all tiles of a map, where it has some.
std::filesystem::path name_pattern(const std::filesystem::path& file) {
    const std::filesystem::path pattern = find_tile_pattern(file);
    return pattern.empty() ? file : pattern;
}

/// Another frame, which came meanwhile, may name another one there.
bool is_file_of(const Scene& scene, size_t displacement, int udim, const std::string& file) {
    if (displacement >= scene.displacements.size()) return false;
    return std::ranges::any_of(scene.displacements[displacement].tiles, [&](const MapTile& tile) {
        return tile.udim == udim && tile.texture->file == file;
    });
}

bool is_environment(const std::filesystem::path& file) { return cli::get_lower_extension(file) == ".hdr"; }

bool is_picture(const std::filesystem::path& file) { return cli::get_kind(file) == cli::FileKind::map; }

/// Maps and environments that come with a mesh, or onto it.
SceneInput add_files(SceneInput input, const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files)
        if (is_environment(file))
            input.mesh.environment = file;
        else if (is_picture(file))
            input.mesh.displacement_map = name_pattern(file);
    return input;
}

} // namespace

void Workbench::open(const SceneInput& input) { load({input}); }

void Workbench::load(Load load) {
    if (load.input.mesh.reader.program.empty()) load.input.mesh.reader = cli::make_mesh_reader();
    if (loading_.valid()) // to assign to it would wait
        next_load_ = std::move(load);
    else
        start(std::move(load));
}

void Workbench::start(Load load) {
    message_ = fmt::format("loading {}", load.input.file.filename().string());
    has_news_ = true;
    loading_ = std::async(std::launch::async, [load = std::move(load), on_news = on_news_]() mutable {
        Loaded loaded{std::move(load), std::nullopt, {}};
        try {
            loaded.loaded = load_input(loaded.of.input);
        } catch (const std::exception& error) {
            loaded.error = error.what();
        }
        if (on_news) on_news();
        return loaded;
    });
}

void Workbench::adopt(Loaded loaded) {
    has_news_ = true;
    passing_message_ = message_ = loaded.error;
    load_error_ = loaded.error;
    if (!loaded.loaded) {
        watch_files();
        return;
    }
    const bool is_first = !document_;
    if (!loaded.of.keeps_camera) drop_output("another file is open");
    painter_.reset();
    if (document_) loaded.of.discards ? state_.discard() : state_.keep_now(*document_);
    shot_ = loaded.loaded->shot;
    wanted_frame_.reset();
    timeline_ = {};
    if (shot_) timeline_ = Timeline(loaded.loaded->frames, loaded.loaded->scene.picture.fps.value_or(0));
    document_ = std::make_unique<Document>(loaded.of.input, std::move(*loaded.loaded));
    has_dropped_map_ = loaded.of.has_dropped_map;
    painter_ = std::make_unique<Painter>(*document_);
    ++scene_count_;
    has_new_frame_ = true;
    const Scene& scene = document_->scene();
    scene_camera_ = scene.camera;
    if (is_first || !loaded.of.keeps_camera) {
        camera_.set(scene.camera);
        has_own_camera_ = false;
    }
    document_->set_camera(camera_.get());
    ImageSettings& image = settings_.image;
    const PictureDefaults& picture = scene.picture;
    if (!given_.spp) image.spp = picture.spp.value_or(ImageSettings().spp);
    if (!given_.bounces) image.bounces = picture.bounces.value_or(ImageSettings().bounces);
    if (!given_.seed) image.seed = picture.seed.value_or(0);
    if (!scene.warnings.empty()) message_ = cli::name_map_keys(scene.warnings.front());
    if (!document_->doubts().empty()) message_ = document_->doubts().front();
    if (const auto painted = state_.claim_painted(loaded.of.input.file); !painted.empty())
        message_ = fmt::format("painted before and not saved: {}", painted.front().string());
    state_.add_recent(loaded.of.input.file);
    forget_explanation();
    selected_object_.reset();
    needs_snapshot_ = true;
    watch_files();
    set_motion(Motion::still);
}

void Workbench::refuse_nothing_open() const {
    if (!document_ && !load_error_.empty()) throw Error(ErrorKind::bad_input, {load_error_, "", ""});
}

void Workbench::watch_files() {
    if (!document_) return;
    std::vector<std::filesystem::path> files = {document_->input().file};
    for (const std::string& file : cli::list_files(document_->scene()))
        if (!file.empty()) files.emplace_back(file);
    watch_.watch(files);
}

void Workbench::ask_to_open(const std::vector<std::filesystem::path>& files) {
    const bool is_change = std::ranges::all_of(files, is_environment); // of the scene that is open
    // Nothing is lost with a map that only takes the place of another one.
    const bool is_other_map = has_dropped_map_ && !has_edits() && std::ranges::all_of(files, is_picture);
    if (is_change || is_other_map || !has_unsaved()) return drop(files);
    asked_files_ = files;
    has_news_ = true;
}

void Workbench::drop(const std::vector<std::filesystem::path>& files) { open_files(files, false); }

void Workbench::open_files(const std::vector<std::filesystem::path>& files, bool discards) {
    const auto mesh = std::ranges::find_if(files, is_mesh_file);
    if (mesh == files.end()) {
        const bool is_light = std::ranges::all_of(files, is_environment);
        const bool is_for_mesh = document_ && is_mesh_file(document_->input().file) && !is_light;
        if (is_for_mesh && std::ranges::all_of(files, is_picture))
            return load({add_files(document_->input(), files), true, true, discards});
        for (const std::filesystem::path& file : files) open_alone(file, discards);
        return;
    }
    load({add_files({*mesh, {}, {}}, files), false, false, discards});
}

void Workbench::open_alone(const std::filesystem::path& file, bool discards) {
    const cli::FileKind kind = cli::get_kind(file);
    if (kind != cli::FileKind::map) return load({{file, {}, {}}, false, false, discards});
    if (!document_) {
        message_ = "drop a mesh first, then its map";
        has_news_ = true;
        return;
    }
    if (is_environment(file)) {
        change_document([&](Document& document) {
            document.load_environment(file);
            if (is_mesh_file(document.input().file)) painter_->forget_lighting(); // all of it is another
        });
        watch_files();
        return;
    }
    message_ = "a map goes onto a mesh alone; a scene names its maps itself";
    has_news_ = true;
}

/// Maps come as edits; of anything else the whole scene is read again.
void Workbench::reload(const std::vector<std::filesystem::path>& files) {
    std::vector<std::filesystem::path> maps;
    for (const std::filesystem::path& file : files) {
        bool is_map = false;
        for (const Displacement& map : document_->scene().displacements)
            for (const MapTile& tile : map.tiles) is_map |= tile.texture->file == file;
        if (is_map) maps.push_back(file);
    }
    if (maps.size() == files.size()) return reread(maps);
    if (!has_edits()) return read_again();
    message_ = fmt::format("{} changed on the disk: save what was changed here, or open it again",
                           files.front().filename().string());
    has_news_ = true;
}

void Workbench::reread(const std::vector<std::filesystem::path>& maps) {
    std::vector<std::pair<RereadMap, std::filesystem::path>> places;
    const Scene& scene = document_->scene();
    for (size_t k = 0; k < scene.displacements.size(); ++k)
        for (const MapTile& tile : scene.displacements[k].tiles)
            if (std::ranges::find(maps, std::filesystem::path(tile.texture->file)) != maps.end())
                places.push_back({{k, tile.udim, {}}, tile.texture->file});
    rereading_ = std::async(std::launch::async,
                            [places = std::move(places), on_news = on_news_, count = scene_count_]() mutable {
                                Reread result;
                                result.scene_count = count;
                                try {
                                    for (auto& [map, file] : places) {
                                        map.texels = read_texture(file);
                                        result.maps.push_back(std::move(map));
                                    }
                                } catch (const std::exception& error) {
                                    result.error = error.what();
                                }
                                if (on_news) on_news();
                                return result;
                            });
}

void Workbench::adopt(Reread reread) {
    if (reread.scene_count != scene_count_) return; // another scene was opened meanwhile
    has_news_ = true;
    if (!reread.error.empty()) { // what was read last stays
        message_ = reread.error;
        return;
    }
    std::vector<MapEdit> edits;
    for (RereadMap& map : reread.maps) {
        if (!is_file_of(document_->scene(), map.displacement, map.udim, map.texels.file)) continue;
        const Displacement& displacement = document_->scene().displacements[map.displacement];
        if (document_->has_painted(displacement.name)) {
            message_ =
                fmt::format("the file of '{}' changed; what was painted on it stays", displacement.name);
            continue;
        }
        edits.push_back(make_whole_edit(displacement, map.udim, map.texels));
        if (!document_->replace_tile(map.displacement, map.udim, std::move(map.texels))) return read_again();
    }
    if (edits.empty()) return;
    painter_->end();
    painter_->forget();
    passing_message_ = message_ = "read again: the map changed";
    needs_snapshot_ = true;
    if (choose_use() != SessionUse::scenes) return send(std::move(edits));
    document_->note_replaced_tiles(); // the session takes scenes, and no edits
    set_motion(Motion::moving);
}

std::filesystem::path Workbench::suggest_file(const char* extension) const {
    std::filesystem::path file = document_ ? document_->input().file : std::filesystem::path("scene.json");
    std::string stem = file.stem().string();
    if (!stem.ends_with("-view")) stem += "-view";
    for (int k = 2;
         extension == std::string(".json") && document_ && file.parent_path() / (stem + extension) == file;
         ++k)
        stem = fmt::format("{}-{}", stem, k);
    file.replace_filename(stem + extension);
    return frame() && extension == std::string(".exr") ? name_frame(file, *frame()) : file;
}

bool Workbench::save(const std::filesystem::path& file) {
    if (!document_) return false;
    return attempt([&] {
        document_->set_camera(camera_.get());
        const std::vector<std::filesystem::path> written = document_->save(file, settings_.image);
        for (const std::filesystem::path& path : written) watch_.accept(path);
        has_dropped_map_ = false;
        state_.forget_painted();
        message_ = fmt::format("wrote {}", file.string());
        if (const std::vector<int> frames = document_->list_frames_aside(); !frames.empty())
            message_ += fmt::format(", without what was painted at frame {}: show and save that as well",
                                    fmt::join(frames, ", "));
        passing_message_ = message_;
        has_news_ = true;
    });
}

void Workbench::discard() {
    state_.discard();
    is_discarded_ = true;
}

bool Workbench::save_map(size_t displacement, const std::filesystem::path& file, const std::string& preset) {
    if (!document_) return false;
    return attempt([&] {
        Displacement to = document_->scene().displacements.at(displacement);
        if (!preset.empty()) to = choose_convention(preset, to);
        document_->save_map(displacement, file, to);
        if (!document_->has_painted()) state_.forget_painted();
        passing_message_ = message_ = fmt::format("wrote {}", file.string());
        has_news_ = true;
    });
}

void Workbench::write_picture(const std::filesystem::path& file) {
    timeline_.pause();
    wanted_frame_.reset(); // what is seen is meant
    output_ = file;
    message_ = fmt::format("{} is written when all samples are there", file.filename().string());
    has_news_ = true;
    if (motion_ != Motion::still) set_motion(Motion::still);
    if (is_done()) finish_output();
}

void Workbench::drop_output(const char* reason) {
    if (output_.empty()) return;
    message_ = fmt::format("{} is not written: {}", std::exchange(output_, {}).filename().string(), reason);
    passing_message_ = message_;
    note_message();
}

void Workbench::finish_output() {
    if (output_.empty() || !is_done()) return;
    const std::filesystem::path file = std::exchange(output_, {});
    attempt([&] {
        Image image = shown_picture()->image;
        for (const auto& [name, value] : output_metadata_) image.metadata[name] = value;
        write_image(image, file);
        passing_message_ = message_ = fmt::format("wrote {}", file.string());
    });
}

} // namespace relief::viewer
