// Members of a short list, kind by kind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace relief::cpu {

/// Calls use(members) once for each kind of the members 0 to `count` - 1, at most kMost, whose kinds
/// find_kind(member) tells: kinds and the members of each as they come.
template <size_t kMost, class FindKind, class Use>
void visit_kinds(size_t count, const FindKind& find_kind, const Use& use) {
    std::array<uint32_t, kMost> waiting, chosen;
    for (size_t k = 0; k < count; ++k) waiting[k] = uint32_t(k);
    while (count > 0) {
        const auto kind = find_kind(waiting[0]);
        size_t chosen_count = 0, left = 0;
        for (size_t n = 0; n < count; ++n) {
            const uint32_t member = waiting[n];
            if (find_kind(member) == kind)
                chosen[chosen_count++] = member;
            else
                waiting[left++] = member;
        }
        use(std::span<const uint32_t>(chosen.data(), chosen_count));
        count = left;
    }
}

} // namespace relief::cpu
