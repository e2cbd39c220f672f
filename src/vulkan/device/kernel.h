// Pipelines with one common set layout (vulkan/layout/bindings.h), so that buffers are bound once for all:
// compute shaders, and fragment shaders that write buffers only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vulkan/device/buffer.h"
#include "vulkan/device/device.h"

namespace relief::vulkan {

struct KernelConfig {
    std::string shader; ///< file in shaders/ without its suffix, e.g. "bottom_build"
    /// Specialization constants 0, 1, 2, ...; constant 0 is the work-group size of every kernel.
    std::vector<uint32_t> constants;
    /// SPIR-V, read during construction only; empty: of the shader of that name in shaders/.
    std::span<const uint32_t> code = {};
    /// If not empty, `shader` is a fragment shader drawn with this vertex shader, on a device for the method
    /// fragment or hybrid. With kFullScreen a launch acts as a compute dispatch in groups of kFragmentGroup.
    std::string vertex_shader = {};
};

inline constexpr const char* kFullScreen = "full_screen";
inline constexpr uint32_t kFragmentGroup = 64;

/// A compiled shader with its constants; equal ones share a pipeline. The device must outlive it.
class Kernel {
  public:
    Kernel() noexcept;
    Kernel(const Device& device, const KernelConfig& config);
    ~Kernel();
    Kernel(Kernel&&) noexcept;
    Kernel& operator=(Kernel&&) noexcept;

    uint32_t group_size() const;
    bool is_drawn() const;

    struct Implementation;
    const Implementation& internals() const { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

/// Of kernels with one invocation a ray, path or pixel.
inline constexpr uint32_t kGroupSize = 64;

/// A kernel in groups of kGroupSize without further constants.
Kernel make_kernel(const Device& device, const char* shader);

/// The buffers bound to kernels, by binding number. A buffer bound as texels must have a format.
class BindingTable {
  public:
    explicit BindingTable(const Device& device);
    ~BindingTable();

    /// Binds the whole `buffer`, not during a submission. Numbers from kFirstTexelBinding on are uniform
    /// texel buffers, those below storage buffers. Unbound numbers refer to a buffer of zeros.
    void bind(uint32_t binding, const Buffer& buffer);

    /// Unbinds a buffer, as is required before one is destroyed without a replacement.
    void clear();

    struct Implementation;
    Implementation& internals() const { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
