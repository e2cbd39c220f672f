#include "surface/mesh/patch_budget.h"

#include <utility>

#include <fmt/format.h>

#include "base/machine.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr uint64_t kMostPatches = uint64_t(1) << 27;
/// At the peak: refined topology, polygons, patches and their split vertices.
constexpr uint64_t kBytesPerPatch = 900;

} // namespace

void check_patch_count(uint64_t count, const std::string& where, const std::string& what) {
    const auto refuse = [&](std::string message) {
        throw Error(ErrorKind::out_of_memory,
                    {std::move(message), where, "set a lower level of its subdivision"});
    };
    if (count > kMostPatches)
        refuse(fmt::format("{} makes {} patches, at most {} are possible", what, count, kMostPatches));
    const uint64_t available = available_memory_bytes();
    if (count * kBytesPerPatch > available)
        refuse(fmt::format("{} makes {} patches and needs {} bytes ({:.1f} GiB), {:.1f} GiB are available",
                           what, count, count * kBytesPerPatch, double(count * kBytesPerPatch) / (1 << 30),
                           double(available) / (1 << 30)));
}

} // namespace relief
