// Which light a point draws, and how likely: by the estimates of a few, or down a tree of many.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "formulas/light_tree.h"
#include "prepare/light_sources.h"

namespace relief::cpu {

/// Immutable once made.
class LightChoice {
  public:
    LightChoice() = default;
    explicit LightChoice(LightTables tables) : tables_(std::move(tables)) {}

    /// Lights that may be drawn and are no emissive surface.
    std::span<const scalar::LightSourceData> sources() const { return tables_.sources; }
    /// Whether a light of the scene's list lights the object that the point is on.
    bool is_lit(const scalar::LightSourceData& source, const scalar::LitPoint& at) const {
        return source.link == kNoIndex ||
               scalar::is_in_set(tables_.link_words[source.link + at.instance / 32], at.instance);
    }
    /// What the texture of a light that has one adds to its colour where a ray meets it.
    Vec3f fetch_color(const scalar::LightSourceData& source, const Vec3f& origin,
                      const Vec3f& direction) const;
    /// Of them, those that are chosen by their estimates.
    std::span<const scalar::LightSourceData> listed() const { return sources().first(tables_.listed_count); }
    bool has_tree() const { return !tables_.nodes.empty(); }

    struct Pick {
        const scalar::LightSourceData* source; ///< null: an emissive patch, or all is dark
        uint32_t emitter;                      ///< that patch; kNoIndex: a source, or all is dark
        float probability;                     ///< > 0 but in the dark
    };
    /// `u_further` continues `u` where that has too few digits: of many lights.
    Pick pick(const scalar::LitPoint& at, float u, float u_further) const;

    /// Probabilities of a point's lights. Those of the sources that are listed are shares of `listed`, times
    /// `list_share`; the tree has the rest.
    struct Shares {
        float listed;     ///< sum of their estimates
        float list_share; ///< 1 without a tree
    };
    Shares find_shares(const scalar::LitPoint& at) const;
    float find_probability(const Shares& shares, const scalar::LightSourceData& source,
                           const scalar::LitPoint& at) const;
    /// Of an emissive patch; without a tree of all of them.
    float find_emitter_probability(const scalar::LitPoint& at, uint32_t emitter) const;

    /// Calls visit(source, find_probability) for the lights of the tree that a ray from `at` may meet; of
    /// those that it does meet, find_probability() is to be called.
    template <class Visit>
    void visit_met(const scalar::LitPoint& at, const Shares& shares, const Vec3f& direction, float distance,
                   const Visit& visit) const;
    /// Calls visit(source) for the sources that a camera ray may meet and see.
    template <class Visit>
    void visit_seen(const Vec3f& origin, const Vec3f& direction, float distance, const Visit& visit) const;

    size_t byte_count() const;

  private:
    float estimate(const scalar::LightSourceData& source, const scalar::LitPoint& at) const;
    float total_estimate(const scalar::LitPoint& at) const;
    float estimate_child(uint32_t node, const scalar::LitPoint& at) const;
    float estimate_alone(const scalar::LightNodeData& node, const scalar::LitPoint& at) const;
    Pick pick_listed(const scalar::LitPoint& at, float u, float total) const;
    Pick pick_in_tree(const scalar::LitPoint& at, float u, float u_further) const;
    float find_in_tree(const scalar::LitPoint& at, uint32_t leaf) const;
    template <class Visit>
    void visit_leaves(const Vec3f& origin, const Vec3f& direction, float distance, uint32_t flag,
                      const Visit& visit) const;

    LightTables tables_;
};

/// Calls visit(leaf) for the leaves with a flag whose spheres a ray meets.
template <class Visit>
void LightChoice::visit_leaves(const Vec3f& origin, const Vec3f& direction, float distance, uint32_t flag,
                               const Visit& visit) const {
    for (uint32_t k = 0; k < tables_.nodes.size();) {
        const scalar::LightNodeData& node = tables_.nodes[k];
        const bool is_met = (node.flags & flag) != 0 && scalar::may_meet(node, origin, direction, distance);
        if (is_met && node.source != scalar::kNone) visit(k);
        k = is_met ? k + 1 : node.end;
    }
}

template <class Visit>
void LightChoice::visit_met(const scalar::LitPoint& at, const Shares& shares, const Vec3f& direction,
                            float distance, const Visit& visit) const {
    visit_leaves(at.position, direction, distance, scalar::kCanBeMet, [&](uint32_t leaf) {
        const scalar::LightSourceData& source = tables_.sources[tables_.nodes[leaf].source];
        if (!is_lit(source, at)) return;
        visit(source, [&] { return (1 - shares.list_share) * find_in_tree(at, leaf); });
    });
}

template <class Visit>
void LightChoice::visit_seen(const Vec3f& origin, const Vec3f& direction, float distance,
                             const Visit& visit) const {
    for (const scalar::LightSourceData& source : listed())
        if (source.is_visible != 0) visit(source);
    visit_leaves(origin, direction, distance, scalar::kCanBeSeen,
                 [&](uint32_t leaf) { visit(tables_.sources[tables_.nodes[leaf].source]); });
}

} // namespace relief::cpu
