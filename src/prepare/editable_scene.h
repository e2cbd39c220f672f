// A prepared scene with write access, for prepare_scene() and SceneEditor alone: others get it const.
#pragma once

#include <memory>
#include <vector>

#include "prepare/prepared_scene.h"

namespace relief {

struct EditableScene {
    std::shared_ptr<PreparedScene> scene;
    std::vector<std::shared_ptr<MipChain>> mips; ///< of PreparedScene::maps, where they are filtered
};

} // namespace relief
