#include "base/machine.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace relief {

namespace {

constexpr uint64_t kUnknown = std::numeric_limits<uint64_t>::max();

uint64_t read_number(const char* file) {
    std::ifstream stream(file);
    uint64_t value = 0;
    return stream >> value ? value : kUnknown;
}

/// Value, in bytes, of a key in a file with lines "Key: N kB"; other lines are ignored.
uint64_t read_bytes(const char* file, const std::string& wanted) {
    std::ifstream stream(file);
    uint64_t kibibytes = 0;
    for (std::string key; stream >> key;) {
        if (key == wanted) return stream >> kibibytes ? kibibytes * 1024 : kUnknown;
        stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return kUnknown;
}

} // namespace

std::string processor_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);)
        if (line.rfind("model name", 0) == 0)
            if (const size_t colon = line.find(": "); colon != std::string::npos)
                return line.substr(colon + 2);
    return "cpu";
}

uint64_t peak_resident_bytes() {
    // Preferred to getrusage, which includes memory held before exec, at times that of the parent process.
    const uint64_t peak = read_bytes("/proc/self/status", "VmHWM:");
    if (peak != kUnknown) return peak;
    rusage usage{};
    return getrusage(RUSAGE_SELF, &usage) == 0 ? uint64_t(usage.ru_maxrss) * 1024 : 0;
}

uint64_t available_memory_bytes() {
    uint64_t available = read_bytes("/proc/meminfo", "MemAvailable:");
    const uint64_t limit = read_number("/sys/fs/cgroup/memory.max");
    const uint64_t used = read_number("/sys/fs/cgroup/memory.current");
    if (limit != kUnknown && used != kUnknown)
        available = std::min(available, limit > used ? limit - used : 0);
    return available;
}

} // namespace relief
