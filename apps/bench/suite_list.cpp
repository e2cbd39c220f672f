#include "bench/suite_list.h"

#include <fmt/format.h>

#include "base/suggest.h"
#include "relief/error.h"

namespace relief::bench {

const std::vector<SuiteText>& list_suites() {
    static const std::vector<SuiteText> kSuites = {
        {"paper1",
         "table and figures of Harada 2015 (default)",
         {"--scenes", "--size", "--level", "--tessellated-limit", "--engine", "--bottom", "--threads",
          "--isa"}},
        {"paper2",
         "builders and traversals over triangle meshes",
         {"--scenes", "--mesh", "--size", "--engine", "--threads"}},
        {"paper3",
         "structures, traversals and render methods of GRAPP 2019",
         {"--scenes", "--mesh", "--size", "--engine", "--threads"}},
        {"cycles",
         "displaced scenes beside Blender's Cycles, where `blender` is found",
         {"--scenes", "--size", "--threads"}},
        {"quality",
         "error against time beside Blender's Cycles, denoised and not",
         {"--scenes", "--size", "--threads"}},
        {"characters",
         "subdivision surfaces of characters beside Cycles in Blender, from cold and in sessions",
         {"--scenes", "--mesh", "--vdm", "--space", "--blender", "--size", "--threads"}},
        {"edits",
         "a painted rectangle of a map until the next picture, beside a fresh load",
         {"--size", "--threads", "--isa"}},
        {"frame",
         "samples a second of path-traced frames, in turn with another build where --baseline names one",
         {"--scenes", "--baseline", "--size", "--spp", "--engine", "--threads", "--isa"}},
#ifdef RELIEF_EMBREE
        {"triangles", "plain triangle meshes on the CPU against Embree", {"--mesh", "--isa"}},
        {"peers",
         "displaced surfaces on the CPU against Embree's three ways",
         {"--scenes", "--scene", "--levels", "--size", "--tessellated-limit", "--threads", "--isa"}},
#endif
    };
    return kSuites;
}

const SuiteText& find_suite(const std::string& name) {
    std::vector<std::string_view> names;
    for (const SuiteText& suite : list_suites()) {
        if (suite.name == name) return suite;
        names.push_back(suite.name);
    }
    throw Error(ErrorKind::usage, {fmt::format("unknown suite '{}', known: {}", name, fmt::join(names, ", ")),
                                   "", suggest_word(name, names)});
}

std::string describe_suites() {
    std::string text;
    for (const SuiteText& suite : list_suites())
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", suite.name, suite.help);
    return text;
}

} // namespace relief::bench
