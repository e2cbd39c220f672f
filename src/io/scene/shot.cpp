#include "relief/shot.h"

#include <utility>

#include <fmt/format.h>

#include "io/file_system.h"
#include "io/mesh/gltf_uri.h"
#include "io/scene/asset_cache.h"
#include "io/scene/frame_reader.h"
#include "io/scene/json_node.h"
#include "io/scene/tile_names.h"
#include "relief/error.h"

namespace relief {

namespace {

/// Adds the files that a mesh file reads beside itself. What is wrong with it, reading it tells.
void add_buffers(const std::filesystem::path& file, std::vector<std::filesystem::path>& files) {
    if (get_lower_extension(file) != ".gltf") return;
    const Json root = Json::parse(read_file_bytes(file), nullptr, false);
    if (!root.is_object() || !root.contains("buffers") || !root["buffers"].is_array()) return;
    for (const Json& buffer : root["buffers"])
        if (buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string())
            if (const auto uri = buffer["uri"].get<std::string>(); !is_data_uri(uri)) try {
                    files.push_back(file.parent_path() / decode_path_uri(uri));
                } catch (const Error&) {
                }
}

} // namespace

struct Shot::Implementation {
    std::filesystem::path file;
    FrameReader reader;
    MeshReaderSettings settings;
};

Shot::Shot(const std::filesystem::path& file, const MeshReaderSettings& reader) {
    refuse_foreign_file(file);
    const std::string name = file.string();
    implementation_.reset(new Implementation{
        file,
        FrameReader(parse_json(read_file_bytes(file), name), name, AssetCache(file.parent_path()), reader),
        reader});
}

Shot::Shot(std::string_view text, const std::filesystem::path& folder, SceneAssets assets,
           const MeshReaderSettings& reader)
    : implementation_(new Implementation{
          folder / "scene",
          FrameReader(parse_json(text, "scene"), "scene", AssetCache(folder, std::move(assets)), reader),
          reader}) {}

void Shot::change_text(std::string_view text, SceneAssets assets) {
    const std::filesystem::path folder = implementation_->file.parent_path();
    std::unique_ptr<Implementation> next(new Implementation{
        implementation_->file,
        FrameReader(parse_json(text, "scene"), "scene", AssetCache(folder), implementation_->settings),
        implementation_->settings});
    next->reader.take_over_pictures(implementation_->reader, std::move(assets));
    implementation_ = std::move(next);
}

Shot::~Shot() = default;
Shot::Shot(Shot&&) noexcept = default;
Shot& Shot::operator=(Shot&&) noexcept = default;

const std::vector<int>& Shot::frames() const { return implementation_->reader.frames(); }

bool Shot::is_animated() const { return implementation_->reader.is_animated(); }

std::vector<std::filesystem::path> Shot::list_files(double frame) const {
    Implementation& self = *implementation_;
    const AssetCache assets(self.file.parent_path());
    std::vector<std::filesystem::path> files = {self.file};
    for (const std::string& name : self.reader.list_names(frame)) {
        const std::filesystem::path file = assets.resolve(split_picture_name(name).file);
        std::error_code code;
        if (has_tile_token(name))
            for (auto& [udim, tile] : find_tiles(file)) files.push_back(std::move(tile));
        else if (std::filesystem::exists(file, code))
            files.push_back(file), add_buffers(file, files);
        else
            throw Error(ErrorKind::bad_input,
                        {"there is no such file", file.string(),
                         fmt::format("{} names it at frame {}", self.file.string(), frame)});
    }
    return files;
}

Scene Shot::load(double frame) { return implementation_->reader.load(frame); }

SceneUpdate Shot::update(double frame) { return implementation_->reader.update(frame); }

std::optional<Shot::View> Shot::find_view(double frame) const {
    return implementation_->reader.find_view(frame);
}

} // namespace relief
