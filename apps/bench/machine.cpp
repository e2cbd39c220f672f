#include "bench/machine.h"

#include <fstream>
#include <string>
#include <thread>

#include <sys/utsname.h>

#include <nlohmann/json.hpp>

#include "relief/devices.h"
#include "relief/version.h"

namespace relief::bench {

namespace {

using Json = nlohmann::ordered_json;

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

Json describe_build() {
    return {{"version", RELIEF_VERSION_STRING}, {"commit", RELIEF_COMMIT}, {"compiler", __VERSION__}};
}

Json describe_machine() {
    return {{"system", read_system()},
            {"processor", read_processor()},
            {"threads", std::thread::hardware_concurrency()}};
}

Json describe_vulkan_devices() {
    Json devices = Json::array();
    for (const DeviceInfo& device : vulkan_devices())
        devices.push_back({{"device", device.index},
                           {"name", device.name},
                           {"driver", device.driver},
                           {"kind", device.kind},
                           {"memory_bytes", device.memory_bytes},
                           {"missing", device.missing}});
    return devices;
}

Json describe_device(const Statistics& s) {
    Json result = {{"engine", s.engine}, {"name", s.device}, {"isa", s.isa}, {"threads", s.threads}};
    if (s.engine != "vulkan") return result;
    for (const DeviceInfo& device : vulkan_devices())
        if (device.name == s.device) result["driver"] = device.driver;
    return result;
}

} // namespace relief::bench
