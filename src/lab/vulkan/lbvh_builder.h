// Linear BVHs over a mesh, built on the device: node for node the trees of lab/trees/lbvh.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "lab/trees/lbvh.h"
#include "lab/vulkan/device_tree.h"

namespace relief::vulkan {

/// What a build took. Times are the device's own, where it has a clock; on a CPU they are of the submission.
struct BuildReport {
    enum class Part { boxes, codes, sort, hierarchy, refit };
    static constexpr size_t kPartCount = 5;

    uint32_t primitive_count = 0;
    int code_bits = 30;
    uint64_t heap_slots = 0; ///< 0: no heap
    std::array<double, kPartCount> seconds{};
    std::array<uint64_t, kPartCount> bytes{}; ///< that the kernels read and write

    double total_seconds() const;
    double primitives_per_second() const { return primitive_count / total_seconds(); }
};

/// Least bytes that such a build reads and writes, at one pass of sort per eight bits. A triangle: 18 box, 26
/// code (30 with 63 bits), 68 sort (200); linked trees: 24 links (28), 68 leaves, 88 inner nodes; heaps: 36
/// entry (40), and 64 a slot, written on the way down and up.
double compute_least_build_bytes(const BuildReport& report);

/// Share of the rate that memory traffic allows; `bandwidth`: measure_copy_bandwidth.
double compute_bound_share(const BuildReport& report, double bandwidth);

/// Bytes read and written a second by copies within the device's memory: the best of some, `bytes` each way.
double measure_copy_bandwidth(const Device& device, uint64_t bytes = 64u << 20);

/// Keeps its working memory from build to build. One thread at a time. The device must outlive it.
class DeviceLbvhBuilder {
  public:
    explicit DeviceLbvhBuilder(const Device& device);
    ~DeviceLbvhBuilder();

    /// As LbvhBuilder::build and make_linked_bvh, from finite triangles; the buffers have room for a node
    /// pair a triangle. Throws Error{out_of_memory}.
    DeviceTree build(const DeviceMesh& mesh, const LbvhBuilder::Config& config);

    /// As LbvhBuilder::build_heap.
    DeviceTree build_heap(const DeviceMesh& mesh, const LbvhBuilder::HeapConfig& config);

    /// Of the last build.
    const BuildReport& report() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
