// The instruction sets that this machine can run, for what Highway dispatches.
#pragma once

// First: which ones are compiled is said here.
#include "math/lane_targets.h"

#include <cstdint>

#include <hwy/targets.h>

namespace relief::test {

/// Calls check() once for each; the best one is chosen again afterwards.
template <class Check> void check_on_every_target(const Check& check) {
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        check();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace relief::test
