// The light that a point draws, and how likely that is: path/light_choice.h over tables in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "formulas/constants.h"
#include "formulas/light_tree.h"
#include "prepare/light_sources.h"

namespace relief {
namespace scalar {

/// The functions of path/light_choice.h; the tables must outlive it.
class LightChooser {
  public:
    explicit LightChooser(const LightTables& tables) : tables_(tables) {}

    /// Whether a light of the scene's list lights the object that the point is on.
    bool is_lit(const LightSourceData& source, const LitPoint& at) const {
        return source.link == kNoIndex ||
               is_in_set(tables_.link_words[source.link + at.instance / 32], at.instance);
    }
    float estimate_source(const LightSourceData& source, const LitPoint& at) const {
        if (!is_lit(source, at)) return 0;
        // The estimate of these two is their power. To take it here spares a call.
        const bool is_far = source.kind == kSourceEnvironment || source.kind == kSourceSun;
        return is_far ? source.power : estimate_irradiance(source, at.position);
    }
    bool has_light_tree() const { return !tables_.nodes.empty(); }

#define In(Type) const Type&
#include "path/light_choice.h"
#undef In

  private:
    const LightSourceData& load_light_source(uint k) const { return tables_.sources[k]; }
    const LightNodeData& load_light_node(uint k) const { return tables_.nodes[k]; }

    const LightTables& tables_;
};

} // namespace scalar

namespace cpu {

/// Immutable once made.
class LightChoice {
  public:
    LightChoice() = default;
    explicit LightChoice(LightTables tables) : tables_(std::move(tables)) {}

    /// Lights that may be drawn and are no emissive surface.
    std::span<const scalar::LightSourceData> sources() const { return tables_.sources; }
    bool is_lit(const scalar::LightSourceData& source, const scalar::LitPoint& at) const {
        return chooser().is_lit(source, at);
    }
    /// What the texture of a light that has one adds to its colour where a ray meets it.
    Vec3f fetch_color(const scalar::LightSourceData& source, const Vec3f& origin,
                      const Vec3f& direction) const;
    /// Of them, those that are chosen by their estimates.
    std::span<const scalar::LightSourceData> listed() const { return sources().first(tables_.listed_count); }
    bool has_tree() const { return chooser().has_light_tree(); }

    struct Pick {
        const scalar::LightSourceData* source; ///< null: an emissive patch, or no light reaches the point
        uint32_t emitter;  ///< number of that patch; kNoIndex: a source, or no light reaches the point
        float probability; ///< 0: no light reaches the point
    };
    /// `u_further` is a second random number, for choices of which `u` has too few digits.
    Pick pick(const scalar::LitPoint& at, float u, float u_further) const;

    /// Probabilities of the lights of a point. Listed sources have their estimates' shares of `listed`, times
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
    static constexpr uint32_t kRoot = 0;

    scalar::LightChooser chooser() const { return scalar::LightChooser(tables_); }
    template <class Visit>
    void visit_leaves(const Vec3f& origin, const Vec3f& direction, float distance, uint32_t flag,
                      const Visit& visit) const;

    LightTables tables_;
};

/// Calls visit(leaf) for the leaves with a flag whose spheres a ray meets.
template <class Visit>
void LightChoice::visit_leaves(const Vec3f& origin, const Vec3f& direction, float distance, uint32_t flag,
                               const Visit& visit) const {
    const uint32_t end = uint32_t(tables_.nodes.size());
    const auto find_next = [&](uint32_t place) {
        return chooser().find_leaf(place, end, origin, direction, distance, flag);
    };
    for (uint32_t k = find_next(kRoot); k < end; k = find_next(k + 1)) visit(k);
}

template <class Visit>
void LightChoice::visit_met(const scalar::LitPoint& at, const Shares& shares, const Vec3f& direction,
                            float distance, const Visit& visit) const {
    visit_leaves(at.position, direction, distance, scalar::kCanBeMet, [&](uint32_t leaf) {
        const scalar::LightSourceData& source = tables_.sources[tables_.nodes[leaf].source];
        if (!is_lit(source, at)) return;
        visit(source, [&] { return (1 - shares.list_share) * chooser().find_in_tree(kRoot, at, leaf); });
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

} // namespace cpu
} // namespace relief
