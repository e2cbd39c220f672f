// A Vulkan device made ready for a render method: chosen, checked for what Relief needs, with its queue and
// pipeline cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "relief/render.h"

namespace relief::vulkan {

/// What memory is for: the accounts that byte counts are kept in.
enum class Purpose { geometry, structures, displacement, bottom_cache, ray_buffers, staging };
inline constexpr size_t kPurposeCount = 6;

/// One physical device and why it can or cannot be used.
struct DeviceDescription {
    uint32_t index = 0; ///< what --device takes
    std::string name, driver;
    bool is_cpu = false;
    uint64_t memory_bytes = 0;        ///< of its largest device-local heap
    std::vector<std::string> missing; ///< features and limits that Relief needs and it lacks; empty: usable
    std::vector<std::string> missing_to_draw; ///< and for the methods fragment and hybrid, beyond `missing`
};

/// All devices of all drivers, in the loader's order; empty where there is no driver. Never throws for a
/// missing driver.
std::vector<DeviceDescription> list_devices();

/// Immutable once made, apart from its memory accounts and the pipelines that it keeps; one thread at a time
/// may record and submit.
class Device {
  public:
    struct Config {
        int index = -1; ///< of list_devices(); -1: the first usable GPU, else the first usable device
        RenderMethod method = RenderMethod::compute; ///< others need more of a device
        std::filesystem::path pipeline_cache;        ///< file; empty: nothing is kept between runs
        /// Khronos validation with synchronisation validation; each message is kept, see
        /// validation_messages().
        bool is_validated = false;
        /// Copies through staging memory even where the host reaches the device's memory; for tests.
        bool is_staged = false;
    };

    /// Throws Error{device_missing}: no driver, no such index, or features that are named.
    explicit Device(const Config& config);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceDescription& description() const;
    bool is_cpu() const { return description().is_cpu; }
    RenderMethod method() const;

    /// Bytes that one storage buffer may have.
    uint64_t max_buffer_bytes() const;
    /// Texels that one texel buffer may have.
    uint64_t max_texel_count() const;
    uint32_t max_group_size() const; ///< invocations
    uint32_t max_draw_size() const;  ///< pixels a side
    /// Work groups to keep the device busy with persistent kernels.
    uint32_t resident_group_count() const;
    /// Device memory that may still be allocated.
    uint64_t available_bytes() const;

    uint64_t allocated_bytes(Purpose purpose) const;
    uint64_t peak_bytes(Purpose purpose) const;

    /// Messages of the validation layer so far (warnings and errors); empty when not validated.
    std::vector<std::string> validation_messages() const;

    struct Implementation; ///< Vulkan's types stay in the files that need them (device_internals.h)
    Implementation& internals() const { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
