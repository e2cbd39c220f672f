// A Vulkan device for a render method: selected and checked, with its queue and pipeline cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "relief/render.h"

namespace relief::vulkan {

/// Purpose of memory: the accounts of byte counts.
enum class Purpose { geometry, structures, displacement, bottom_cache, ray_buffers, staging };
inline constexpr size_t kPurposeCount = 6;

/// One physical device and whether it is usable.
struct DeviceDescription {
    uint32_t index = 0; ///< value for --device
    std::string name, driver;
    bool is_cpu = false;
    uint64_t memory_bytes = 0;                ///< size of its largest device-local heap
    std::vector<std::string> missing;         ///< required features and limits that it lacks; empty: usable
    std::vector<std::string> missing_to_draw; ///< further ones required by the methods fragment and hybrid
};

/// All devices of all drivers, in the loader's order; empty without a driver, which is not an error.
std::vector<DeviceDescription> list_devices();

/// Immutable but for memory accounts and cached pipelines; one thread at a time may record and submit.
class Device {
  public:
    struct Config {
        int index = -1; ///< of list_devices(); -1: the first usable GPU, else the first usable device
        RenderMethod method = RenderMethod::compute; ///< other methods require more features
        std::filesystem::path pipeline_cache;        ///< file; empty: no cache between runs
        /// Enables Khronos validation with synchronisation validation; see validation_messages().
        bool is_validated = false;
        /// Always copies through staging memory, even if the host can access device memory; for tests.
        bool is_staged = false;
        /// Uses the logical device and the pipelines of earlier Devices of this process; see shared_device.h.
        bool is_shared = true;
        /// Compiles kernels, with statistics (kernel_statistics.h), and does nothing else: its buffers hold
        /// nothing, and commands are dropped. A driver without a device will do. Requires
        /// VK_KHR_pipeline_executable_properties.
        bool compiles_only = false;
    };

    /// Throws Error{device_missing}: no driver, no such index, or missing features, which it names.
    explicit Device(const Config& config);
    ~Device();

    const DeviceDescription& description() const;
    bool is_cpu() const { return description().is_cpu; }
    RenderMethod method() const;

    /// Maximum bytes of a storage buffer.
    uint64_t max_buffer_bytes() const;
    /// Maximum texels of a texel buffer.
    uint64_t max_texel_count() const;
    uint32_t max_group_size() const; ///< invocations
    uint32_t max_draw_size() const;  ///< pixels per side
    /// Work groups of a persistent kernel that fill the device.
    uint32_t resident_group_count() const;
    /// Device memory that can still be allocated.
    uint64_t available_bytes() const;
    /// Device memory that this Device holds, whether buffers have it or not.
    uint64_t held_bytes() const;

    uint64_t allocated_bytes(Purpose purpose) const;
    uint64_t peak_bytes(Purpose purpose) const;

    /// While this lives, what comes next on the device ends with StopRequest (base/stop_request.h) once it
    /// is asked for: before each compilation and submission, and on a CPU device, which takes seconds for the
    /// launch of a large batch, also between its parts (Commands). Not while another thread uses the device.
    class StopScope {
      public:
        StopScope(const Device& device, std::function<bool()> is_asked_for);
        ~StopScope();
        StopScope(const StopScope&) = delete;
        StopScope& operator=(const StopScope&) = delete;

      private:
        const Device& device_;
    };

    /// Warnings and errors of the validation layer so far; empty without validation.
    std::vector<std::string> validation_messages() const;

    struct Implementation; ///< Vulkan's types stay in the files that need them (device_internals.h)
    Implementation& internals() const { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
