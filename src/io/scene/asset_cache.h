// Textures of one scene: each file is read once and shared.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// What a texture is for decides what is done to its values: `data` nothing; `colour` decodes integers from
/// sRGB; `radiance` refuses NaN and infinity and lifts negative values to 0; `vector` refuses NaN and
/// infinity; `number` as well, and leaves one channel of the texture.
enum class TextureUse { data, colour, radiance, vector, number };

/// As a channel of a number: that of the colour that the first three are, linear Rec.709.
inline constexpr uint32_t kLuminanceChannel = 4;

class AssetCache {
  public:
    explicit AssetCache(std::filesystem::path folder, SceneAssets given = {})
        : folder_(std::move(folder)), given_(std::move(given)) {}

    std::filesystem::path resolve(const std::string& file) const;
    /// `channel`, from 0, comes first in the texture; `space` of colours and radiance: as the file holds them
    /// (io/picture/colour_space.h), empty for sRGB where integers are colours and else linear Rec.709; of
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

    /// Textures of another cache are not read again.
    void reuse(AssetCache& other) { earlier_ = std::move(other.textures_); }
    /// Those of it that were not asked for are let go.
    void forget_earlier() { earlier_.clear(); }
    /// Moves a mesh in memory out of the assets; nullopt for a file. Throws Error{bad_input} the second time.
    std::optional<Mesh> take_mesh(const std::string& file);

    /// What was noticed while reading, in order.
    std::vector<std::string>& warnings() { return warnings_; }

  private:
    std::shared_ptr<const Texture> find_given(const std::string& file) const;
    std::shared_ptr<const Texture> decode(std::shared_ptr<Texture> texture, TextureUse use, uint32_t channel,
                                          const std::string& space);
    std::vector<MapTile> load_given_tiles(const std::string& pattern, TextureUse use, uint32_t channel,
                                          const std::string& space);

    std::filesystem::path folder_;
    using TextureKey = std::tuple<std::string, TextureUse, uint32_t, std::string>;
    SceneAssets given_;
    std::map<TextureKey, std::shared_ptr<const Texture>> textures_, earlier_;
    std::vector<std::string> warnings_;
};

/// Throws bad_input with pixel and tile (0: none) for a NaN or an infinity in the first three channels.
void check_finite(const Texture& texture, int udim);

/// Value of channel `channel` of texel (x, y).
float get_texel(const Texture& texture, uint32_t x, uint32_t y, uint32_t channel);

} // namespace relief
