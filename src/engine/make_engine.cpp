// Picks the engine. The one place that knows both.
#include "engine/engine.h"

#include <utility>

#include "relief/error.h"

namespace relief {

std::unique_ptr<Engine> make_engine(std::shared_ptr<const PreparedScene> scene,
                                    const RenderSettings& settings) {
    if (settings.engine == EngineKind::cpu) return make_cpu_engine(std::move(scene), settings);
#ifdef RELIEF_VULKAN
    return make_vulkan_engine(std::move(scene), settings);
#else
    throw Error(ErrorKind::device_missing, {"this build has no Vulkan", "render settings",
                                            "--engine cpu, or configure it with -DRELIEF_VULKAN=ON"});
#endif
}

} // namespace relief
