#include "bench/machine.h"

#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include <sys/utsname.h>

#include "relief/devices.h"
#include "relief/version.h"

namespace relief::bench {

namespace {

std::string read_system() {
    utsname names{};
    return uname(&names) == 0 ? std::string(names.sysname) + " " + names.release + " " + names.machine
                              : "unknown";
}

std::string read_processor() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);)
        if (const size_t colon = line.find(": "); line.rfind("model name", 0) == 0 && colon != line.npos)
            return line.substr(colon + 2);
    return "unknown";
}

} // namespace

Value describe_build() {
    return {{"version", RELIEF_VERSION_STRING}, {"commit", kCommit}, {"compiler", __VERSION__}};
}

Value describe_machine() {
    return {{"system", read_system()},
            {"processor", read_processor()},
            {"threads", std::thread::hardware_concurrency()}};
}

Value describe_load() {
    double means[3];
    if (getloadavg(means, 3) != 3) return {};
    return {{"one_minute", means[0]}, {"five_minutes", means[1]}, {"fifteen_minutes", means[2]}};
}

Value describe_vulkan_devices() {
    Value devices = Value::list();
    for (const DeviceInfo& device : vulkan_devices())
        devices.push_back({{"device", device.index},
                           {"name", device.name},
                           {"driver", device.driver},
                           {"kind", device.kind},
                           {"memory_bytes", device.memory_bytes},
                           {"missing", device.missing}});
    return devices;
}

Value describe_device(const Statistics& s) {
    Value result = {{"engine", s.engine}, {"name", s.device}, {"isa", s.isa}, {"threads", s.threads}};
    if (s.engine != "vulkan") return result;
    for (const DeviceInfo& device : vulkan_devices())
        if (device.name == s.device) result["driver"] = device.driver;
    return result;
}

} // namespace relief::bench
