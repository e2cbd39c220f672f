// Short words for what tests of inspection ask.
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "relief/inspect.h"

namespace relief::test {

/// The text of the first finding with this code; empty: there is none.
inline std::string find_text(const Inspection& inspection, const std::string& code) {
    for (const Finding& finding : inspection.findings)
        if (finding.code == code) return finding.text;
    return {};
}

inline bool has_code(const Inspection& inspection, const std::string& code) {
    return !find_text(inspection, code).empty();
}

inline size_t count_severe(const Inspection& inspection) {
    return size_t(std::count_if(inspection.findings.begin(), inspection.findings.end(),
                                [](const Finding& finding) { return finding.severity != Severity::note; }));
}

/// The value of a fact; empty: there is none.
inline std::string get_fact(const Inspection& inspection, const std::string& name) {
    for (const Fact& fact : inspection.facts)
        if (fact.name == name) return fact.value;
    return {};
}

inline Displacement make_map(std::shared_ptr<const Texture> texture) {
    Displacement map;
    map.name = "map";
    map.tiles.push_back({1001, std::move(texture)});
    return map;
}

#define EXPECT_HAS_PART(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

} // namespace relief::test
