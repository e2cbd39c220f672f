// What strokes changed, in blocks of texels, and how maps, materials, the environment and lights were before
// they were changed, so that all of it can be taken back and made again.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "relief/image.h"
#include "relief/scene.h"
#include "viewer/brush.h"
#include "viewer/changed_fields.h"

namespace relief::viewer {

/// One image of a displacement map.
struct TilePlace {
    size_t displacement = 0;
    int udim = 1001;
    friend auto operator<=>(const TilePlace&, const TilePlace&) = default;
};

/// What one of a scene was: how a displacement was meant, without its texels; the environment, whose texture
/// does not count; a material or a light.
struct SceneValue {
    size_t index = 0; ///< of the displacement, material or light
    std::variant<Displacement, Material, Environment, Light> value;
    ChangedFields::Fields changed = 0; ///< what of it differs from the file, and stays at other frames
};
Displacement get_meaning(const Displacement& map);

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
    /// What something was before a change, a step by itself. Without `is_new` it goes on with the step before
    /// where that is one of the same thing.
    void note_value(const SceneValue& before, bool is_new);
    bool has_strokes() const;
    /// Calls `change(value)` for each step that is no stroke.
    template <class Change> void change_values(const Change& change) {
        for (std::deque<Step>* const steps : {&done_, &undone_})
            for (Step& step : *steps)
                if (auto* const value = std::get_if<SceneValue>(&step)) change(*value);
    }

    bool can_undo() const { return !done_.empty() && !open_; }
    bool can_redo() const { return !undone_.empty() && !open_; }
    void clear();
    /// Forgets how the environment and lights were.
    void forget_lighting();

    /// What the last stroke changed: calls `change(place, box)` for each block that was put back, and keeps
    /// what `find(place)` holds there for redo. Of a step that is no stroke, `set_value(before)` puts
    /// that back and returns what it was.
    template <class Find, class Change, class SetValue>
    void undo(const Find& find, const Change& change, const SetValue& set_value) {
        if (can_undo()) exchange(done_, undone_, find, change, set_value);
    }
    template <class Find, class Change, class SetValue>
    void redo(const Find& find, const Change& change, const SetValue& set_value) {
        if (can_redo()) exchange(undone_, done_, find, change, set_value);
    }

  private:
    struct BlockKey {
        TilePlace place;
        uint32_t column = 0, row = 0;
        friend auto operator<=>(const BlockKey&, const BlockKey&) = default;
    };
    using Stroke = std::map<BlockKey, Texture>;
    using Step = std::variant<Stroke, SceneValue>;

    static TexelBox get_box(const BlockKey& key, const Texture& map);
    void forget_oldest();

    template <class Find, class Change>
    static Stroke put_back(Stroke& stroke, const Find& find, const Change& change) {
        Stroke other;
        for (auto& [key, texels] : stroke) {
            Texture& map = find(key.place);
            const TexelBox box = get_box(key, map);
            other[key] = copy_texels(map, box);
            paste_texels(texels, box, map);
            change(key.place, box);
        }
        return other;
    }

    template <class Find, class Change, class SetValue>
    static void exchange(std::deque<Step>& from, std::deque<Step>& to, const Find& find, const Change& change,
                         const SetValue& set_value) {
        Step step = std::move(from.back());
        from.pop_back();
        if (auto* const stroke = std::get_if<Stroke>(&step))
            to.push_back(put_back(*stroke, find, change));
        else
            to.push_back(set_value(std::get<SceneValue>(step)));
    }

    std::deque<Step> done_, undone_;
    std::optional<Stroke> open_;
};

} // namespace relief::viewer
