#include "viewer/stroke_history.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace relief::viewer {

namespace {

template <class Number>
void copy_rows(const std::vector<Number>& from, uint32_t from_width, const TexelBox& box,
               std::vector<Number>& to) {
    if (from.empty()) return;
    const size_t row = 4 * size_t(box.x1 - box.x0);
    to.resize(row * size_t(box.y1 - box.y0));
    for (int y = box.y0; y < box.y1; ++y)
        std::copy_n(from.begin() + ptrdiff_t(4 * (size_t(y) * from_width + size_t(box.x0))), row,
                    to.begin() + ptrdiff_t(row * size_t(y - box.y0)));
}

template <class Number>
void paste_rows(const std::vector<Number>& from, const TexelBox& box, uint32_t to_width,
                std::vector<Number>& to) {
    if (from.empty()) return;
    const size_t row = 4 * size_t(box.x1 - box.x0);
    for (int y = box.y0; y < box.y1; ++y)
        std::copy_n(from.begin() + ptrdiff_t(row * size_t(y - box.y0)), row,
                    to.begin() + ptrdiff_t(4 * (size_t(y) * to_width + size_t(box.x0))));
}

} // namespace

Texture copy_texels(const Texture& from, const TexelBox& box) {
    Texture texels;
    texels.width = uint32_t(box.x1 - box.x0);
    texels.height = uint32_t(box.y1 - box.y0);
    texels.channel_count = from.channel_count;
    texels.source_type = from.source_type;
    copy_rows(from.floats, from.width, box, texels.floats);
    copy_rows(from.halves, from.width, box, texels.halves);
    return texels;
}

void paste_texels(const Texture& texels, const TexelBox& box, Texture& to) {
    paste_rows(texels.floats, box, to.width, to.floats);
    paste_rows(texels.halves, box, to.width, to.halves);
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
