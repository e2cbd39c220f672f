// Picks the kernels of shading by the name of their instruction set.
#include "cpu/shading/shading_kernels.h"

#include <cstring>

#include "kernel_isas.h"

namespace relief {

#define X(isa, space, target)                                                                                \
    namespace space {                                                                                        \
    const cpu::ShadingKernels& shading_kernels(const char* name);                                            \
    }
RELIEF_EACH_ISA(X)
#undef X

namespace cpu {

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
