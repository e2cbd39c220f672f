// An FBX file as its importer takes it, with the facts that the importer does not know.
#pragma once

#include <filesystem>
#include <string>

#include "io/mesh/fbx_facts.h"

namespace relief {

struct FbxSource {
    std::string bytes;
    FbxFacts facts;
};

/// Throws bad_input for versions before 7.1.
FbxSource read_fbx_source(const std::filesystem::path& file);

} // namespace relief
