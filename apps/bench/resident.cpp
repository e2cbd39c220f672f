#include "bench/resident.h"

#include <fstream>
#include <limits>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace relief::bench {

namespace {

/// A value of /proc/self/status, in KiB.
std::optional<uint64_t> read_status(const std::string& key) {
    std::ifstream stream("/proc/self/status");
    std::string word;
    while (stream >> word) {
        uint64_t kibibytes = 0;
        if (word == key + ":" && stream >> kibibytes) return kibibytes * 1024;
        stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return std::nullopt;
}

/// Resets the peak to the current resident size (proc(5), clear_refs).
bool reset_peak() {
    std::ofstream stream("/proc/self/clear_refs");
    stream << "5" << std::flush;
    return bool(stream);
}

} // namespace

ResidentMeter::ResidentMeter() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    if (reset_peak()) start_ = read_status("VmRSS");
}

std::optional<uint64_t> ResidentMeter::growth() const {
    const std::optional<uint64_t> peak = read_status("VmHWM");
    if (!start_ || !peak) return std::nullopt;
    return *peak > *start_ ? *peak - *start_ : 0;
}

} // namespace relief::bench
