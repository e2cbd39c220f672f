// Records and runs dispatches and draws: one queue, one submission at a time, timed per stage.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "vulkan/device/buffer.h"
#include "vulkan/device/kernel.h"

namespace relief::vulkan {

/// Timed stages, named as the keys of `stage_s`. From tree_boxes on: of tree builds and walks by themselves.
enum class Stage {
    top_traversal,
    sort,
    bottom_build,
    bottom_traversal,
    shade,
    film,
    tree_boxes,
    tree_codes,
    tree_hierarchy,
    tree_refit,
    tree_walk,
    copy
};
inline constexpr size_t kStageCount = 12;

struct DrawSize {
    uint32_t width = 0, height = 0; ///< pixels, at most Device::max_draw_size() each
};

/// Not thread safe. A full memory barrier separates any two commands: each sees earlier writes. While a stop
/// may be asked for (Device::StopScope), a CPU device runs each launch of more than kPartGroups groups, and
/// each indirect one, in parts that have submissions of their own: as many groups as take some hundredths of
/// a second.
class Commands {
  public:
    Commands(const Device& device, const BindingTable& bindings);
    ~Commands();

    /// Further commands count as `stage`. Submits first on CPU devices: their timestamps are coarse.
    void begin_stage(Stage stage);

    /// Dispatches ceil(invocations / group size) groups, in two dimensions above 65535; kernels compute the
    /// group index as gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x and must skip excess
    /// invocations. Kernels drawn with kFullScreen get as many fragments (shaders/kernel.glsl).
    template <class Push> void dispatch(const Kernel& kernel, uint64_t invocations, const Push& push) {
        dispatch_bytes(kernel, invocations, std::as_bytes(std::span(&push, 1)));
    }
    /// Reads the size at `offset` bytes of `arguments` (created with is_indirect): group counts x, y, z; for
    /// a kernel that is drawn, the arguments of a draw, kArgumentDrawWord words further on.
    template <class Push>
    void dispatch_indirect(const Kernel& kernel, const Buffer& arguments, uint64_t offset, const Push& push) {
        dispatch_indirect_bytes(kernel, arguments, offset, std::as_bytes(std::span(&push, 1)));
    }
    /// Draws triangles with the kernel's own vertex shader over `size` pixels.
    template <class Push>
    void draw(const Kernel& kernel, DrawSize size, uint32_t vertex_count, const Push& push) {
        draw_bytes(kernel, size, vertex_count, std::as_bytes(std::span(&push, 1)));
    }
    /// Writes `value` to every word of [offset, + bytes); both multiples of 4.
    void fill(const Buffer& buffer, uint64_t offset, uint64_t bytes, uint32_t value);
    void copy(const Buffer& from, uint64_t from_offset, const Buffer& to, uint64_t to_offset, uint64_t bytes);

    /// Groups of the smallest part of a launch.
    static constexpr uint32_t kPartGroups = 32;

    /// Submits the recorded commands and waits. Throws Error{device_missing} if the device is lost;
    /// StopRequest, with the recorded commands discarded, if a stop was asked for.
    void run();

    /// Discards recorded commands after an error.
    void discard();

    /// Accumulated seconds of each stage.
    const std::array<double, kStageCount>& stage_seconds() const;
    uint64_t dispatch_count() const;

  private:
    void dispatch_bytes(const Kernel& kernel, uint64_t invocations, std::span<const std::byte> push);
    void dispatch_indirect_bytes(const Kernel& kernel, const Buffer& arguments, uint64_t offset,
                                 std::span<const std::byte> push);
    void draw_bytes(const Kernel& kernel, DrawSize size, uint32_t vertex_count,
                    std::span<const std::byte> push);
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
