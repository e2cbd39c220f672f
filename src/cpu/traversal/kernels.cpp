// Picks the kernels of an instruction set, of traversal and of shading.
#include "cpu/traversal/kernels.h"

#include <cstring>

#include <hwy/targets.h>

#include "cpu/shading/shading_kernels.h"
#include "kernel_isas.h"

namespace relief {

#define X(isa, space, target)                                                                                \
    namespace space {                                                                                        \
    const cpu::Kernels& kernels(const char* name);                                                           \
    const cpu::ShadingKernels& shading_kernels(const char* name);                                            \
    }
RELIEF_EACH_ISA(X)
#undef X

namespace cpu {

namespace {

/// Kernels of one instruction set where they were compiled in and can run.
const Kernels* pick(Isa isa) {
    const int64_t supported = hwy::SupportedTargets() | HWY_EMU128;
    switch (isa) {
#define X(isa, space, target)                                                                                \
    case Isa::isa:                                                                                           \
        return supported & target ? &space::kernels(#isa) : nullptr;
        RELIEF_EACH_ISA(X)
#undef X
    default:
        return nullptr;
    }
}

} // namespace

const Kernels* find_kernels(Isa isa) {
    if (isa != Isa::best) return pick(isa);
    for (const Isa candidate : {Isa::avx512, Isa::avx2, Isa::neon, Isa::sse4, Isa::scalar})
        if (const Kernels* found = pick(candidate)) return found;
    return nullptr;
}

const ShadingKernels& find_shading_kernels(const char* name) {
#define X(isa, space, target) &space::shading_kernels(#isa),
    const ShadingKernels* const all[] = {RELIEF_EACH_ISA(X)};
#undef X
    const ShadingKernels* found = all[0];
    for (const ShadingKernels* kernels : all)
        if (std::strcmp(kernels->name, name) == 0) found = kernels;
    return *found;
}

} // namespace cpu

} // namespace relief
