#include "api/make_engine.h"

#include <utility>

#include "cpu/cpu_engine.h"
#include "lab/scene_walks.h"
#include "relief/error.h"
#ifdef RELIEF_VULKAN
#include "vulkan/vulkan_engine.h"
#endif

namespace relief {

std::unique_ptr<Engine> make_engine(std::shared_ptr<const PreparedScene> scene,
                                    const RenderSettings& settings) {
    if (settings.device.engine == EngineKind::cpu) {
        std::unique_ptr<const cpu::SceneWalk> walk = make_scene_walk(*scene, settings);
        return make_cpu_engine(std::move(scene), settings, std::move(walk));
    }
#ifdef RELIEF_VULKAN
    std::optional<vulkan::SceneWalk> walk = vulkan::make_device_walk(*scene, settings);
    return make_vulkan_engine(std::move(scene), settings, std::move(walk));
#else
    throw Error(ErrorKind::device_missing, {"this build has no Vulkan", "render settings",
                                            "device.engine = cpu, or configure it with -DRELIEF_VULKAN=ON"});
#endif
}

} // namespace relief
