// What strokes changed, in blocks of texels, so that they can be taken back and made again.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "relief/image.h"
#include "viewer/brush.h"

namespace relief::viewer {

/// One image of a displacement map.
struct TilePlace {
    size_t displacement = 0;
    int udim = 1001;
    friend auto operator<=>(const TilePlace&, const TilePlace&) = default;
};

/// The texels of a rectangle inside of a map.
Texture copy_texels(const Texture& from, const TexelBox& box);
/// Puts them back; the maps hold numbers of the same kind.
void paste_texels(const Texture& texels, const TexelBox& box, Texture& to);

class StrokeHistory {
  public:
    static constexpr uint32_t kBlockSide = 64;       ///< texels
    static constexpr size_t kMostBytes = 256u << 20; ///< beyond it the oldest strokes are forgotten

    /// Everything before can be taken back until a new stroke begins; what was taken back is forgotten.
    void begin();
    /// Keeps what blocks under `box`, inside of the map, hold before it is changed.
    void keep(const TilePlace& place, const Texture& texture, const TexelBox& box);
    /// A stroke that changed nothing is none.
    void end();
    bool is_open() const { return open_.has_value(); }

    bool can_undo() const { return !done_.empty() && !open_; }
    bool can_redo() const { return !undone_.empty() && !open_; }
    void clear();

    /// What the last stroke changed: calls `change(place, box)` for each block that was put back, and keeps
    /// what `find(place)` holds there for redo.
    template <class Find, class Change> void undo(const Find& find, const Change& change) {
        if (can_undo()) exchange(done_, undone_, find, change);
    }
    template <class Find, class Change> void redo(const Find& find, const Change& change) {
        if (can_redo()) exchange(undone_, done_, find, change);
    }

  private:
    struct BlockKey {
        TilePlace place;
        uint32_t column = 0, row = 0;
        friend auto operator<=>(const BlockKey&, const BlockKey&) = default;
    };
    using Stroke = std::map<BlockKey, Texture>;

    static TexelBox get_box(const BlockKey& key, const Texture& map);
    void forget_oldest();

    template <class Find, class Change>
    void exchange(std::deque<Stroke>& from, std::deque<Stroke>& to, const Find& find, const Change& change) {
        Stroke other;
        for (auto& [key, texels] : from.back()) {
            Texture& map = find(key.place);
            const TexelBox box = get_box(key, map);
            other[key] = copy_texels(map, box);
            paste_texels(texels, box, map);
            change(key.place, box);
        }
        from.pop_back();
        to.push_back(std::move(other));
    }

    std::deque<Stroke> done_, undone_;
    std::optional<Stroke> open_;
};

} // namespace relief::viewer
