// Which traversals go with which structure and engine, and their names.
#include "prepare/traversals.h"

#include <iterator>

namespace relief {

std::vector<TraversalKind> available_traversals(EngineKind, StructureKind structure) {
    using T = TraversalKind;
    switch (structure) {
    case StructureKind::bvh:
        return {T::wide, T::stack, T::restart_trail, T::parent_link, T::skip_link, T::trail, T::pair_trail};
    case StructureKind::lbvh:
        return {T::trail, T::stack, T::restart_trail, T::parent_link, T::skip_link, T::pair_trail};
    case StructureKind::kdtree:
        return {T::push_down, T::restart, T::backtrack};
    }
    return {};
}

TraversalKind choose_traversal(const RenderSettings& settings, EngineKind engine) {
    return settings.experiment.traversal == TraversalKind::automatic
               ? available_traversals(engine, settings.experiment.structure).front()
               : settings.experiment.traversal;
}

bool is_default_traversal(const RenderSettings& settings, EngineKind engine) {
    return settings.experiment.structure == StructureKind::bvh &&
           choose_traversal(settings, engine) == TraversalKind::wide;
}

const char* traversal_name(TraversalKind traversal) {
    constexpr const char* kNames[] = {"auto",        "wide",      "stack",    "restart-trail",
                                      "parent-link", "skip-link", "trail",    "pair-trail",
                                      "restart",     "push-down", "backtrack"};
    static_assert(std::size(kNames) == kTraversalCount);
    return kNames[size_t(traversal)];
}

const char* structure_name(StructureKind structure) {
    constexpr const char* kNames[] = {"bvh", "lbvh", "kdtree"};
    return kNames[size_t(structure)];
}

} // namespace relief
