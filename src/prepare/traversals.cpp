// Which traversals go with which structure and engine, and their names.
#include "prepare/traversals.h"

namespace relief {

std::vector<TraversalKind> available_traversals(EngineKind engine, StructureKind structure) {
    using T = TraversalKind;
    switch (structure) {
    case StructureKind::bvh:
        if (engine == EngineKind::cpu)
            return {T::wide,      T::stack, T::restart_trail, T::parent_link,
                    T::skip_link, T::trail, T::pair_trail};
        return {T::stack, T::restart_trail, T::parent_link, T::skip_link, T::trail, T::pair_trail};
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
    const TraversalKind own = engine == EngineKind::cpu ? TraversalKind::wide : TraversalKind::stack;
    return settings.experiment.structure == StructureKind::bvh && choose_traversal(settings, engine) == own;
}

const char* traversal_name(TraversalKind traversal) {
    switch (traversal) {
    case TraversalKind::automatic:
        return "auto";
    case TraversalKind::wide:
        return "wide";
    case TraversalKind::stack:
        return "stack";
    case TraversalKind::restart_trail:
        return "restart-trail";
    case TraversalKind::parent_link:
        return "parent-link";
    case TraversalKind::skip_link:
        return "skip-link";
    case TraversalKind::trail:
        return "trail";
    case TraversalKind::pair_trail:
        return "pair-trail";
    case TraversalKind::restart:
        return "restart";
    case TraversalKind::push_down:
        return "push-down";
    case TraversalKind::backtrack:
        return "backtrack";
    }
    return "";
}

const char* structure_name(StructureKind structure) {
    switch (structure) {
    case StructureKind::bvh:
        return "bvh";
    case StructureKind::lbvh:
        return "lbvh";
    case StructureKind::kdtree:
        return "kdtree";
    }
    return "";
}

} // namespace relief
