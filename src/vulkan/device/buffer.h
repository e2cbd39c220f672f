// Device buffers with a name and a purpose; every byte is accounted for.
#pragma once

#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vulkan/device/device.h"

namespace relief::vulkan {

/// find_texel of buffer.cpp keeps this order.
enum class TexelFormat {
    none,
    r32_float,
    rg32_float,
    rgba32_float,
    rgba16_float,
    r32_uint,
    rg32_uint,
    rgba32_uint
};

/// Bytes of one texel; 0 for none.
uint32_t texel_bytes(TexelFormat format);

struct BufferConfig {
    std::string name;   ///< debug name, and for messages
    uint64_t bytes = 0; ///< 0 is allowed and creates a buffer of the minimum size
    Purpose purpose = Purpose::ray_buffers;
    TexelFormat format = TexelFormat::none; ///< other than none: also usable as a uniform texel buffer
    bool is_indirect = false;               ///< usable for indirect arguments
    bool is_host_visible = false;           ///< mapped and coherent: for counters that the host polls
};

/// A storage buffer. Movable; frees its memory on destruction. The device must outlive it.
class Buffer {
  public:
    Buffer() noexcept;
    /// Throws Error{out_of_memory} with the byte count where memory or the limit of a buffer ends.
    Buffer(const Device& device, const BufferConfig& config);
    ~Buffer();
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;

    uint64_t byte_count() const; ///< as requested
    explicit operator bool() const { return implementation_ != nullptr; }

    /// Copies host memory to bytes [offset, + data.size()), through staging memory where needed; blocks.
    void upload(std::span<const std::byte> data, uint64_t offset = 0);
    template <class T> void upload(const std::vector<T>& values, uint64_t offset = 0) {
        upload(std::as_bytes(std::span(values)), offset);
    }
    /// Copies bytes [offset, + data.size()) to the host; blocks.
    void download(std::span<std::byte> data, uint64_t offset = 0) const;
    template <class T> std::vector<T> download(size_t count, uint64_t offset = 0) const {
        std::vector<T> values(count);
        download(std::as_writable_bytes(std::span(values)), offset);
        return values;
    }
    /// Calls `take` with bytes [offset, + count) part by part, in order; each part but the last is a multiple
    /// of `unit`, which staging memory has room for. What it gets is valid during the call only. Blocks.
    void visit(uint64_t offset, uint64_t count, uint64_t unit,
               const std::function<void(std::span<const std::byte>)>& take) const;
    /// Mapped memory; host-visible buffers only. Valid after a completed submission.
    void* mapped() const;

    struct Implementation;
    Implementation& internals() const { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
