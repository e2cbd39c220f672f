#include "viewer/shared_scene.h"

#include <utility>

namespace relief::viewer {

SharedMeshes share_meshes(const std::vector<Mesh>& meshes) {
    SharedMeshes shared;
    for (const Mesh& mesh : meshes) shared.push_back(std::make_shared<const Mesh>(mesh));
    return shared;
}

std::shared_ptr<const SharedScene> share_scene(Scene scene) {
    auto shared = std::make_shared<SharedScene>();
    for (Mesh& mesh : std::exchange(scene.meshes, {}))
        shared->meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
    shared->scene = std::move(scene);
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
