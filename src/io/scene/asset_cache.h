// Textures and numbered meshes of one scene: each file is read once and shared, also between frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/scene/file_sequence.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// What a texture is for decides what is done to its values: `data` nothing; `colour` decodes integers from
/// sRGB; `radiance` refuses NaN and infinity and lifts negative values to 0; `vector` refuses NaN and
/// infinity; `number` as well, and leaves one channel of the texture.
enum class TextureUse { data, color, radiance, vector, number };

/// As a channel of a number: that of the colour that the first three are, linear Rec.709.
inline constexpr uint32_t kLuminanceChannel = 4;

class AssetCache {
  public:
    explicit AssetCache(std::filesystem::path folder, SceneAssets given = {})
        : folder_(std::move(folder)), given_(std::move(given)) {}

    const std::filesystem::path& folder() const { return folder_; }

    std::filesystem::path resolve(const std::string& file) const;
    /// `channel`, from 0, comes first in the texture; `space` of colours and radiance: as the file holds them
    /// (io/picture/color_space.h), empty for sRGB where integers are colours and else linear Rec.709; of
    /// numbers the same, empty for values that are taken as they are. Throws
    /// Error{bad_input} as read_texture and decode_texture, and for a channel that the file lacks.
    std::shared_ptr<const Texture> load(const std::string& file, TextureUse use, uint32_t channel = 0,
                                        const std::string& space = {});
    /// The tiles of a map: one for a plain file, all that exist for a name with a token
    /// (io/scene/tile_names.h). A plain file that is one tile of several is warned of.
    std::vector<MapTile> load_tiles(const std::string& file, TextureUse use, uint32_t channel = 0,
                                    const std::string& space = {});
    /// Those of a displacement map, as they are.
    std::vector<MapTile> load_displacement(const std::string& file) {
        return load_tiles(file, TextureUse::data);
    }

    /// Another scene begins, with these: textures of files that are as they were stay.
    void change_given(SceneAssets given);
    /// The hash of a mesh that is left out; null: it is not.
    const uint64_t* find_kept(const std::string& mesh) const;
    bool has_kept() const { return !given_.kept_meshes.empty(); }

    /// Another reading of the scene begins: it is warned of all again.
    void begin() {
        single_tiles_.clear(), told_of_meshes_.clear(), told_of_pictures_.clear(), warnings_.clear();
    }
    /// What is loaded from now on belongs to a frame; names that name_blend() made are known no more.
    void set_frame(int64_t frame) { frame_ = frame, sequences_.clear(); }
    /// Makes name_blend(files), and the name of one alone, stand for these files of a sequence.
    void add_sequence(const SequenceFiles& files) { sequences_[name_blend(files)] = files; }
    /// The name of a layer and part of a file, or of the files that the name of a sequence stands for.
    std::string name_layer(const std::string& file, const std::string& part, const std::string& layer);
    /// Meshes of sequences stay, though no two of them are blended.
    void keep_meshes(bool is_wanted) { keeps_meshes_ = is_wanted; }
    /// Lets go of what nobody uses and belongs to none of the frames from `first` to `last`.
    void forget(int64_t first, int64_t last);

    /// Throws as load_mesh and blend_meshes.
    Mesh load_polygons(const std::string& file, const MeshReadOptions& options);
    /// Throws as check_finite does for one of the tiles; each texture is looked at once.
    void require_finite(const std::vector<MapTile>& tiles, bool is_udim);

    /// Moves a mesh in memory out of the assets; nullopt for a file. Throws Error{bad_input} the second time.
    std::optional<Mesh> take_mesh(const std::string& file);

    /// What was noticed while reading, in order.
    std::vector<std::string>& warnings() { return warnings_; }
    /// None of these is told; those of meshes are when they are met again.
    void drop_warnings() {
        for (const std::string& warning : warnings_) told_of_meshes_.erase(warning);
        warnings_.clear();
    }

  private:
    /// What a file is known to be the same by.
    struct FileStamp {
        std::filesystem::file_time_type time;
        uintmax_t bytes = 0;
        friend bool operator==(const FileStamp&, const FileStamp&) = default;
    };
    static std::optional<FileStamp> read_stamp(const std::filesystem::path& file);
    std::shared_ptr<const Texture> find_given(const std::string& file) const;
    std::shared_ptr<const Texture> decode(std::shared_ptr<Texture> texture, TextureUse use, uint32_t channel,
                                          const std::string& space);
    std::vector<MapTile> load_given_tiles(const std::string& pattern, TextureUse use, uint32_t channel,
                                          const std::string& space);

    const SequenceFiles* find_blend(const std::string& file) const;
    std::vector<MapTile> load_blend(const SequenceFiles& files);
    /// Adds what was noticed of a mesh, each warning once.
    void warn_of_mesh(const std::vector<std::string>& noticed);
    Mesh read_polygons(const std::string& file, const MeshReadOptions& options);
    std::shared_ptr<const Mesh> load_kept(const std::string& file, const MeshReadOptions& options,
                                          int64_t frame);

    /// What was read, and the frame that it belongs to.
    template <class Value> struct Kept {
        std::shared_ptr<const Value> value;
        int64_t frame = 0;
        std::vector<std::string> warnings = {}; ///< of its file, told again by each reading of the scene
        std::optional<FileStamp> stamp = {};    ///< of its file
    };
    /// Of a blend: nobody but its scene needs it.
    static constexpr int64_t kNoFrame = std::numeric_limits<int64_t>::min();
    /// Stays apart from other pointers though its texture may be gone.
    using Seen = std::set<std::weak_ptr<const Texture>, std::owner_less<>>;

    std::filesystem::path folder_;
    using TextureKey = std::tuple<std::string, TextureUse, uint32_t, std::string>;
    SceneAssets given_;
    std::map<TextureKey, Kept<Texture>> textures_;
    using MeshKey = std::tuple<std::string, int, std::vector<int>, std::string, double>;
    MeshKey make_key(const std::string& file, const MeshReadOptions& options) const {
        return {resolve(file).string(), options.uv_set, options.further_uv_sets, options.animation,
                options.time};
    }
    std::map<MeshKey, Kept<Mesh>> meshes_;
    std::map<std::string, SequenceFiles> sequences_;
    Seen finite_;
    int64_t frame_ = 1;
    bool keeps_meshes_ = false;
    std::set<std::string> told_of_pictures_; ///< warnings of textures
    std::set<std::string> single_tiles_;     ///< names that were looked at
    std::set<std::string> told_of_meshes_;
    std::vector<std::string> warnings_;
};

/// Throws bad_input with pixel and tile (0: none) for a NaN or an infinity in the first three channels.
void check_finite(const Texture& texture, int udim);

/// Value of channel `channel` of texel (x, y).
float get_texel(const Texture& texture, uint32_t x, uint32_t y, uint32_t channel);

} // namespace relief
