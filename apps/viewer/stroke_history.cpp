#include "viewer/stroke_history.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace relief::viewer {

namespace {

/// Texels of `box` from one place to another: of textures that hold the same kind of values.
template <class Number>
void copy_rows(const Texture& from, const std::vector<Number>& values, size_t from_x, size_t from_y,
               const TexelBox& box, const Texture& to, std::vector<Number>& target, size_t to_x,
               size_t to_y) {
    if (values.empty()) return;
    const size_t row = from.stride * size_t(box.x1 - box.x0);
    for (size_t y = 0; y < size_t(box.y1 - box.y0); ++y)
        std::copy_n(values.begin() + ptrdiff_t(from.find_texel(from_x, from_y + y)), row,
                    target.begin() + ptrdiff_t(to.find_texel(to_x, to_y + y)));
}

} // namespace

Texture copy_texels(const Texture& from, const TexelBox& box) {
    Texture texels;
    texels.width = uint32_t(box.x1 - box.x0);
    texels.height = uint32_t(box.y1 - box.y0);
    texels.channel_count = from.channel_count, texels.stride = from.stride;
    texels.source_type = from.source_type;
    (from.halves.empty() ? texels.floats.resize(texels.value_count())
                         : texels.halves.resize(texels.value_count()));
    const auto x = size_t(box.x0), y = size_t(box.y0);
    copy_rows(from, from.floats, x, y, box, texels, texels.floats, 0, 0);
    copy_rows(from, from.halves, x, y, box, texels, texels.halves, 0, 0);
    return texels;
}

void paste_texels(const Texture& texels, const TexelBox& box, Texture& to) {
    const auto x = size_t(box.x0), y = size_t(box.y0);
    copy_rows(texels, texels.floats, 0, 0, box, to, to.floats, x, y);
    copy_rows(texels, texels.halves, 0, 0, box, to, to.halves, x, y);
}

Displacement get_meaning(const Displacement& map) {
    Displacement meaning = map;
    meaning.tiles.clear();
    return meaning;
}

void StrokeHistory::note_value(const SceneValue& before, bool is_new) {
    undone_.clear();
    const auto* const last = done_.empty() ? nullptr : std::get_if<SceneValue>(&done_.back());
    const bool is_same = last && last->index == before.index && last->value.index() == before.value.index();
    if (is_new || !is_same) done_.emplace_back(before);
}

void StrokeHistory::forget_lighting() {
    const auto is_lighting = [](const Step& step) {
        const auto* const value = std::get_if<SceneValue>(&step);
        return value && (std::holds_alternative<Environment>(value->value) ||
                         std::holds_alternative<Light>(value->value));
    };
    std::erase_if(done_, is_lighting), std::erase_if(undone_, is_lighting);
}

bool StrokeHistory::has_strokes() const {
    const auto is_stroke = [](const Step& step) { return std::holds_alternative<Stroke>(step); };
    return std::ranges::any_of(done_, is_stroke) || std::ranges::any_of(undone_, is_stroke);
}

TexelBox StrokeHistory::get_box(const BlockKey& key, const Texture& map) {
    return {int(key.column * kBlockSide), int(key.row * kBlockSide),
            int(std::min((key.column + 1) * kBlockSide, map.width)),
            int(std::min((key.row + 1) * kBlockSide, map.height))};
}

void StrokeHistory::begin() {
    open_.emplace();
    undone_.clear();
}

void StrokeHistory::keep(const TilePlace& place, const Texture& texture, const TexelBox& box) {
    if (!open_ || box.is_empty()) return;
    for (uint32_t row = uint32_t(box.y0) / kBlockSide; row <= uint32_t(box.y1 - 1) / kBlockSide; ++row)
        for (uint32_t column = uint32_t(box.x0) / kBlockSide; column <= uint32_t(box.x1 - 1) / kBlockSide;
             ++column) {
            const BlockKey key{place, column, row};
            if (!open_->contains(key)) (*open_)[key] = copy_texels(texture, get_box(key, texture));
        }
}

void StrokeHistory::end() {
    if (open_ && !open_->empty()) done_.emplace_back(std::move(*open_));
    open_.reset();
    forget_oldest();
}

void StrokeHistory::forget_oldest() {
    size_t bytes = 0;
    const auto count_bytes = [](const Step& step) {
        size_t count = 0;
        if (const auto* const stroke = std::get_if<Stroke>(&step))
            for (const auto& [key, texels] : *stroke) count += texels.byte_count();
        return count;
    };
    for (const Step& step : done_) bytes += count_bytes(step);
    for (; bytes > kMostBytes && done_.size() > 1; done_.pop_front()) bytes -= count_bytes(done_.front());
}

void StrokeHistory::clear() {
    done_.clear(), undone_.clear();
    open_.reset();
}

} // namespace relief::viewer
