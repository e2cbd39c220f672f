// Pipelines over one common set of bindings (vulkan/layout/bindings.h), so that buffers are bound once for
// all: compute shaders, and fragment shaders that write nothing but buffers.
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
    /// SPIR-V of a shader that is not in shaders/; empty: the one of that name. Read while the kernel is
    /// made.
    std::span<const uint32_t> code = {};
    /// Not empty: `shader` is a fragment shader, drawn over the triangles of this vertex shader; the device
    /// must have been made for a method that draws. With kFullScreen a launch is what a dispatch is to a
    /// compute shader, in groups of kFragmentGroup.
    std::string vertex_shader = {};
};

inline constexpr const char* kFullScreen = "full_screen";
inline constexpr uint32_t kFragmentGroup = 64;

/// One compiled shader with its constants. A device compiles each of its shaders once for the same constants,
/// however many kernels there are of it. The device must outlive it.
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

/// The buffers that kernels see, by binding number. A buffer bound as texels must have a format.
class BindingTable {
  public:
    explicit BindingTable(const Device& device);
    ~BindingTable();
    BindingTable(BindingTable&&) noexcept;
    BindingTable& operator=(BindingTable&&) noexcept;

    /// Binds all of `buffer`; not while a submission that uses the table is on its way. Numbers from
    /// kFirstTexelBinding on are uniform texel buffers, those below storage buffers. What is never bound
    /// holds a small buffer of zeros.
    void bind(uint32_t binding, const Buffer& buffer);

    /// As if nothing had been bound: needed before a buffer goes whose place nothing else takes.
    void clear();

    struct Implementation;
    Implementation& internals() const { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
