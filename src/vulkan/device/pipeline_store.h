// The pipelines of a device, each compiled once, however many tracers use it. Part of device_internals.h.
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

/// Thread safe, one compilation at a time. Pipelines stay until the store goes, also where a tracer is made
/// anew because memory ran out; kernels share them with it. A template, so that it knows nothing of Vulkan.
template <class Pipeline> class PipelineStore {
  public:
    /// Shader, vertex shader, constants: as in KernelConfig, of shaders that belong to the build.
    using Key = std::tuple<std::string, std::string, std::vector<uint32_t>>;

    /// The pipeline of `key`; make() is called where there is none yet. What it throws, this throws,
    /// and asks again the next time.
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
