#include "viewer/shared_scene.h"

namespace relief::viewer {

SharedMeshes share_meshes(const std::vector<Mesh>& meshes) {
    SharedMeshes shared;
    for (const Mesh& mesh : meshes) shared.push_back(std::make_shared<const Mesh>(mesh));
    return shared;
}

Scene make_whole(const SharedScene& shared) { return make_next(shared, {}); }

Scene make_next(const SharedScene& shared, const SharedMeshes& before) {
    Scene scene = shared.scene;
    scene.meshes.resize(shared.meshes.size());
    for (size_t k = 0; k < shared.meshes.size(); ++k) {
        const bool is_same = k < before.size() && before[k] == shared.meshes[k];
        if (is_same)
            scene.meshes[k].name = shared.meshes[k]->name;
        else
            scene.meshes[k] = *shared.meshes[k];
    }
    return scene;
}

} // namespace relief::viewer
