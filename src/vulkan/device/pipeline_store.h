// The pipelines of a device, each compiled once and shared by all tracers. Part of device_internals.h.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace relief::vulkan {

/// Thread safe, one compilation at a time. Pipelines live as long as the store, so a tracer recreated after
/// memory ran out reuses them. A template, so that it does not depend on Vulkan.
template <class Pipeline> class PipelineStore {
  public:
    /// Shader, vertex shader, constants: as in KernelConfig, for shaders of the build.
    using Key = std::tuple<std::string, std::string, std::vector<uint32_t>>;

    /// The pipeline of `key`, created by make() if there is none; exceptions of make() propagate.
    template <class Make> std::shared_ptr<const Pipeline> find_or_make(Key key, const Make& make) {
        const std::lock_guard lock(mutex_);
        std::shared_ptr<const Pipeline>& place = pipelines_[std::move(key)];
        if (!place) place = std::make_shared<const Pipeline>(make());
        return place;
    }

  private:
    std::mutex mutex_;
    std::map<Key, std::shared_ptr<const Pipeline>> pipelines_;
};

} // namespace relief::vulkan
