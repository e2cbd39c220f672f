// Linear BVHs built on the device, from boxes that are there already: node for node the trees of
// structures/lbvh.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "engine/vulkan/device_tree.h"
#include "structures/lbvh.h"

namespace relief::vulkan {

/// What a build took. Times are the device's own, where it has a clock; on a CPU they are of the submission.
struct BuildReport {
    enum class Part { boxes, codes, sort, hierarchy, refit };
    static constexpr size_t kPartCount = 5;

    uint32_t primitive_count = 0;
    std::array<double, kPartCount> seconds{};
    std::array<uint64_t, kPartCount> bytes{}; ///< that the kernels read and write

    double total_seconds() const;
    uint64_t total_bytes() const;
    double primitives_per_second() const { return primitive_count / total_seconds(); }
};

/// Bytes a primitive that a build with codes of 30 bits has to read and write, with a sort that goes over its
/// pairs once a pass: 18 for the box and 26 for the code of a triangle, 68 for four passes of eight bits, 24
/// for links, 68 for leaves and 88 for inner nodes.
inline constexpr double kLeastBuildBytes = 290;

/// Share of the rate that memory traffic alone allows; `bandwidth` in bytes a second
/// (measure_copy_bandwidth).
double compute_bound_share(const BuildReport& report, double bandwidth);

/// Bytes read and written a second by copies within the device's memory: the best of some, `bytes` each way.
double measure_copy_bandwidth(const Device& device, uint64_t bytes = 64u << 20);

/// Keeps its working memory from build to build. One thread at a time. The device must outlive it.
class DeviceLbvhBuilder {
  public:
    explicit DeviceLbvhBuilder(const Device& device);
    ~DeviceLbvhBuilder();

    /// As LbvhBuilder::build and make_linked_bvh; the buffers have room for a node pair a primitive. The mesh
    /// or the boxes (six floats each, finite, lower <= upper) are only read. Throws Error{out_of_memory}.
    DeviceTree build(const DeviceMesh& mesh, const LbvhBuilder::Config& config);
    DeviceTree build(const Buffer& boxes, uint32_t box_count, const LbvhBuilder::Config& config);

    /// As LbvhBuilder::build_heap.
    DeviceTree build_heap(const DeviceMesh& mesh, const LbvhBuilder::HeapConfig& config);
    DeviceTree build_heap(const Buffer& boxes, uint32_t box_count, const LbvhBuilder::HeapConfig& config);

    /// Of the last build.
    const BuildReport& report() const;

  private:
    struct Input {
        const DeviceMesh* mesh = nullptr;
        const Buffer* boxes = nullptr; ///< null: of the mesh
        uint32_t count = 0;
    };
    DeviceTree build(const Input& input, const LbvhBuilder::Config& config);
    DeviceTree build_heap(const Input& input, const LbvhBuilder::HeapConfig& config);

    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
