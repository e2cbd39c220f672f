// Textures of one scene: each file is read once and shared.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// What a texture is for decides what is done to its values: `data` nothing; `colour` decodes integers from
/// sRGB; `radiance` refuses NaN and infinity and lifts negative values to 0.
enum class TextureUse { data, colour, radiance };

class AssetCache {
  public:
    explicit AssetCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::filesystem::path resolve(const std::string& file) const;
    std::shared_ptr<const Texture> load(const std::string& file, TextureUse use);
    /// The tiles of a displacement map, checked to be finite: one for a plain file, all that exist for
    /// <UDIM>.
    std::vector<MapTile> load_displacement(const std::string& file);

    /// What was noticed while reading, in order.
    std::vector<std::string>& warnings() { return warnings_; }

  private:
    std::filesystem::path folder_;
    std::map<std::pair<std::string, TextureUse>, std::shared_ptr<const Texture>> textures_;
    std::vector<std::string> warnings_;
};

/// True for a file name with the token <UDIM>.
bool has_udim_token(const std::string& file);

/// Files NAME.1001.EXT and so on for NAME.<UDIM>.EXT, by rising number. Throws bad_input when there is none.
std::vector<std::pair<int, std::filesystem::path>> find_udim_tiles(const std::filesystem::path& pattern);

/// Value of channel `channel` of texel (x, y).
float get_texel(const Texture& texture, uint32_t x, uint32_t y, uint32_t channel);

} // namespace relief
