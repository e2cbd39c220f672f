// From the displacement of the scene to the map that surfaces read: decode matrix, tiles with their pyramids.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "surface/patch/surface.h"

namespace relief {

/// One pyramid a texture for all its surfaces. Thread safe; keeps the textures alive.
class PyramidCache {
  public:
    std::shared_ptr<const BoundsPyramid> get_or_build(const std::shared_ptr<const Texture>& texture);
    /// One that there is already.
    void keep(const std::shared_ptr<const Texture>& texture,
              const std::shared_ptr<const BoundsPyramid>& pyramid);

  private:
    struct Entry {
        std::shared_ptr<const Texture> texture;
        std::shared_ptr<const BoundsPyramid> pyramid;
    };
    std::mutex mutex_;
    std::map<const Texture*, Entry> entries_;
};

/// Throws bad_input with the displacement's `name` for texels that displace by more than 1e18.
void check_reach(const std::string& name, const DisplacementMap& map, const std::string& file,
                 const ChannelRange& range);
/// The same of all tiles.
void check_reach(const std::string& name, const DisplacementMap& map);

/// A length that no texel displaces by more than; 0 without a map.
double find_longest_displacement(const DisplacementMap& map);

/// Throws bad_input with the displacement's name for a map without tiles, an axis out of range, a factor that
/// is not finite, a displacement above 1e18, and whatever BoundsPyramid::build refuses.
/// `neighbours`: as DisplacementMap has them.
DisplacementMap make_displacement_map(const Displacement& displacement, const Affine& object_from_world,
                                      PyramidCache& pyramids, std::vector<TileNeighbours> neighbours = {});

/// Tiles, neighbours and convention alone, with the texels themselves: what TileSurroundings refer to.
DisplacementMap make_texel_map(const Displacement& displacement, std::vector<TileNeighbours> neighbours);

/// Whether any tile continues another one.
bool has_links(const std::vector<TileNeighbours>& neighbours);

} // namespace relief
