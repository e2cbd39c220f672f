#include "vulkan/device/pipeline_cache.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace relief::vulkan {
namespace {

/// Drivers should validate the rest, but truncated files have crashed one: our own trailer detects them.
struct Trailer {
    uint64_t byte_count, hash;
};

uint64_t hash_bytes(const uint8_t* data, size_t count) {
    uint64_t hash = 0xcbf29ce484222325u; // FNV-1a
    for (size_t i = 0; i < count; ++i) hash = (hash ^ data[i]) * 0x100000001b3u;
    return hash;
}

bool is_for_device(const std::vector<uint8_t>& data, const vk::PhysicalDeviceProperties& device) {
    VkPipelineCacheHeaderVersionOne header;
    if (data.size() < sizeof(header)) return false;
    std::memcpy(&header, data.data(), sizeof(header));
    return header.headerSize >= sizeof(header) &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == device.vendorID && header.deviceID == device.deviceID &&
           std::equal(device.pipelineCacheUUID.begin(), device.pipelineCacheUUID.end(),
                      header.pipelineCacheUUID);
}

} // namespace

std::vector<uint8_t> read_pipeline_cache(const std::filesystem::path& path,
                                         const vk::PhysicalDeviceProperties& device) {
    std::ifstream file(path, std::ios::binary);
    std::vector<uint8_t> data{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    Trailer trailer;
    if (data.size() < sizeof(trailer)) return {};
    const size_t count = data.size() - sizeof(trailer);
    std::memcpy(&trailer, data.data() + count, sizeof(trailer));
    if (trailer.byte_count != count || trailer.hash != hash_bytes(data.data(), count)) return {};
    data.resize(count);
    return is_for_device(data, device) ? data : std::vector<uint8_t>();
}

void write_pipeline_cache(const std::filesystem::path& path, const std::vector<uint8_t>& data) noexcept {
    try {
        if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
        // Processes that end at the same time must not share a temporary file.
        std::filesystem::path temporary = path;
        temporary += "." + std::to_string(std::random_device()()) + ".tmp";
        const Trailer trailer{data.size(), hash_bytes(data.data(), data.size())};
        std::ofstream file(temporary, std::ios::binary);
        file.write(reinterpret_cast<const char*>(data.data()), std::streamsize(data.size()));
        file.write(reinterpret_cast<const char*>(&trailer), sizeof(trailer));
        file.close();
        std::error_code error;
        if (file) std::filesystem::rename(temporary, path, error);
        if (!file || error) std::filesystem::remove(temporary, error);
    } catch (const std::exception&) {
        // Not an error: the next run compiles again.
    }
}

} // namespace relief::vulkan
