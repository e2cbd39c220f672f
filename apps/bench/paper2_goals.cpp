#include "bench/paper2_goals.h"

#include <string>

namespace relief::bench {

namespace {

const Value* find_build(const Value& mesh, const std::string& tree) {
    for (const Value& build : mesh["builds"])
        if (build["tree"] == tree) return &build;
    return nullptr;
}

struct CastName {
    std::string tree, traversal, rays, start;
};

/// Seconds; 0 if not measured.
double find_seconds(const Value& mesh, const CastName& name) {
    for (const Value& cast : mesh["casts"])
        if (cast["tree"] == name.tree && cast["traversal"] == name.traversal && cast["rays"] == name.rays &&
            cast["start"] == name.start)
            return cast["seconds"]["median"].get<double>();
    return 0;
}

void add_goal(Value& goals, const std::string& name, double goal, double reached) {
    goals.push_back(
        {{"name", name}, {"goal", goal}, {"reached", reached}, {"unit", "ratio"}, {"met", reached <= goal}});
}

void add_time_goal(Value& goals, const Value& mesh, const std::string& name, const CastName& cast,
                   const CastName& reference) {
    const double seconds = find_seconds(mesh, cast), reference_seconds = find_seconds(mesh, reference);
    if (seconds > 0 && reference_seconds > 0)
        add_goal(goals, mesh["mesh"].get<std::string>() + ", " + name, 1, seconds / reference_seconds);
}

} // namespace

Value make_paper2_goals(const Value& result) {
    Value goals = Value::list();
    for (const Value& mesh : result["meshes"]) {
        const Value *heap = find_build(mesh, "heap"), *succinct = find_build(mesh, "succinct lbvh");
        if (heap && succinct)
            add_goal(goals, mesh["mesh"].get<std::string>() + ", succinct heap against heap, bytes", 0.5,
                     (*succinct)["bytes"].get<double>() / (*heap)["bytes"].get<double>());
        add_time_goal(goals, mesh, "shadow rays of heap and trail, from the last hit against from the root",
                      {"heap", "trail", "shadow", "last hit"}, {"heap", "trail", "shadow", "root"});
        add_time_goal(goals, mesh, "diffuse rays, succinct sah and pair trail against heap and trail",
                      {"succinct sah", "pair-trail", "diffuse", "root"},
                      {"heap", "trail", "diffuse", "root"});
        add_time_goal(goals, mesh, "diffuse rays, succinct sah and pair trail against sah and stack",
                      {"succinct sah", "pair-trail", "diffuse", "root"}, {"sah", "stack", "diffuse", "root"});
    }
    return goals;
}

} // namespace relief::bench
