// The instruction sets that this machine can run, as settings.
#pragma once

#include <vector>

#include "relief/render.h"

namespace relief::test {

inline std::vector<Isa> machine_isas() {
    std::vector<Isa> isas;
    for (const std::string& name : available_isas())
        isas.push_back(name == "avx512" ? Isa::avx512
                       : name == "avx2" ? Isa::avx2
                       : name == "sse4" ? Isa::sse4
                       : name == "neon" ? Isa::neon
                                        : Isa::scalar);
    return isas;
}

} // namespace relief::test
