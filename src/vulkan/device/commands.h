// Records dispatches and draws and runs them: one queue, one submission at a time, the time of each stage
// taken.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "vulkan/device/buffer.h"
#include "vulkan/device/kernel.h"

namespace relief::vulkan {

/// Parts of a frame whose time is told apart; names follow the keys of `stage_s`;
/// from tree_boxes on those of trees that are built and walked for themselves.
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

/// One thread at a time. Every call after a dispatch sees what that dispatch wrote: a full memory barrier
/// stands between any two of them.
class Commands {
  public:
    Commands(const Device& device, const BindingTable& bindings);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    /// What follows counts as `stage`. On a device that is a CPU this runs what was recorded so far, because
    /// timestamps there do not cover short work.
    void begin_stage(Stage stage);

    /// ceil(invocations / group size) groups, in two dimensions above 65535; kernels number their groups by
    /// gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x and leave out what is beyond the end. A
    /// kernel that is drawn with kFullScreen gets as many fragments and numbers them alike
    /// (shaders/kernel.glsl).
    template <class Push> void dispatch(const Kernel& kernel, uint64_t invocations, const Push& push) {
        dispatch_bytes(kernel, invocations, std::as_bytes(std::span(&push, 1)));
    }
    /// Sizes are read at `offset` bytes of `arguments` (made with is_indirect): group counts x, y, z; for a
    /// kernel that is drawn, those of a draw kArgumentDrawWord words further on.
    template <class Push>
    void dispatch_indirect(const Kernel& kernel, const Buffer& arguments, uint64_t offset, const Push& push) {
        dispatch_indirect_bytes(kernel, arguments, offset, std::as_bytes(std::span(&push, 1)));
    }
    /// Draws vertices of a kernel's own vertex shader as triangles over `size` pixels.
    template <class Push>
    void draw(const Kernel& kernel, DrawSize size, uint32_t vertex_count, const Push& push) {
        draw_bytes(kernel, size, vertex_count, std::as_bytes(std::span(&push, 1)));
    }
    /// Writes `value` to every word of [offset, + bytes); both multiples of 4.
    void fill(const Buffer& buffer, uint64_t offset, uint64_t bytes, uint32_t value);
    void copy(const Buffer& from, uint64_t from_offset, const Buffer& to, uint64_t to_offset, uint64_t bytes);

    /// Runs what was recorded and waits. Throws Error{device_missing} when the device is lost, naming what
    /// ran.
    void run();

    /// Forgets what was recorded and not run, after an error on the way.
    void discard();

    /// Seconds of each stage over all runs so far.
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
