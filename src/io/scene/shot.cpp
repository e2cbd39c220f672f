#include "relief/shot.h"

#include <utility>

#include <fmt/format.h>

#include "io/file_system.h"
#include "io/scene/asset_cache.h"
#include "io/scene/keyed_values.h"
#include "io/scene/scene_reader.h"
#include "io/scene/scene_sections.h"
#include "io/scene/tile_names.h"
#include "relief/error.h"

namespace relief {

struct Shot::Implementation {
    std::filesystem::path file;
    std::string name;
    MeshReaderSettings reader;
    Json document;
    bool is_animated = false;
    std::vector<int> frames;
    std::optional<AssetCache> assets; ///< of the scene loaded last
    Json loaded;                      ///< its document, at its frame; empty: all frames have one
    uint64_t content_hash = 0;        ///< of its files

    /// Of a large scene a copy takes time and memory, so it is made only where frames differ.
    template <class Read> auto with_frame(double frame, const Read& read) const {
        check_frame(frame);
        return is_animated ? read(evaluate_frame(document, frame, name)) : read(document);
    }
};

Shot::Shot(const std::filesystem::path& file, const MeshReaderSettings& reader)
    : implementation_(std::make_unique<Implementation>()) {
    refuse_foreign_file(file);
    Implementation& self = *implementation_;
    self.file = file, self.name = file.string(), self.reader = reader;
    self.document = parse_json(read_file_bytes(file), self.name);
    self.is_animated = relief::is_animated(self.document);
    self.frames = read_frames(self.document, self.name);
}

Shot::~Shot() = default;
Shot::Shot(Shot&&) noexcept = default;
Shot& Shot::operator=(Shot&&) noexcept = default;

const std::vector<int>& Shot::frames() const { return implementation_->frames; }

bool Shot::is_animated() const { return implementation_->is_animated; }

std::vector<std::filesystem::path> Shot::list_files(double frame) const {
    const Implementation& self = *implementation_;
    const AssetCache assets(self.file.parent_path());
    std::vector<std::filesystem::path> files = {self.file};
    for (const std::string& name : self.with_frame(frame, list_file_names)) {
        const std::filesystem::path file = assets.resolve(name);
        std::error_code code;
        if (has_tile_token(name))
            for (auto& [udim, tile] : find_tiles(file)) files.push_back(std::move(tile));
        else if (std::filesystem::exists(file, code))
            files.push_back(file);
        else
            throw Error(ErrorKind::bad_input, {"there is no such file", file.string(),
                                               fmt::format("{} names it at frame {}", self.name, frame)});
    }
    return files;
}

Scene Shot::load(double frame) {
    Implementation& self = *implementation_;
    return self.with_frame(frame, [&]<class Document>(Document&& document) {
        AssetCache assets(self.file.parent_path());
        if (self.assets) assets.reuse(*self.assets);
        ReadScene read = read_scene(document, assets, self.name, self.reader);
        assets.forget_earlier();
        self.assets.emplace(std::move(assets)), self.content_hash = read.content_hash;
        if (self.is_animated) self.loaded = std::forward<Document>(document);
        return std::move(read.scene);
    });
}

std::optional<Shot::View> Shot::find_view(double frame) const {
    const Implementation& self = *implementation_;
    if (!self.assets) return std::nullopt; // nothing is loaded
    return self.with_frame(frame, [&](Json document) -> std::optional<View> {
        View view;
        if (const auto camera = document.find("camera"); camera != document.end()) {
            const JsonNode node(*camera, "camera", self.name);
            view.camera = read_camera(node);
            node.with_place([&] { validate_camera(view.camera); });
        }
        view.scene_hash = hash_scene(document, self.content_hash);
        if (!self.is_animated) return view;
        Json loaded = self.loaded;
        document.erase("camera"), loaded.erase("camera");
        return document == loaded ? std::optional(view) : std::nullopt;
    });
}

} // namespace relief
