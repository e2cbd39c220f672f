// From a scene that was read to what is rendered of it.
#pragma once

#include <string>

#include "common/values.h"
#include "relief/error.h"
#include "relief/scene.h"
#include "render_options.h"

namespace relief::cli {

/// Calls `read`; its complaint about a file that is no scene says what scenes and meshes are.
template <class Read> auto with_scene_hint(const RenderOptions& options, const Read& read) {
    const std::string extension = get_lower_extension(options.input);
    try {
        return read();
    } catch (const Error& error) {
        if (extension == ".json" || !error.hint().empty()) throw;
        throw Error(error.kind(),
                    {error.message(), error.where(),
                     "a scene file is JSON; meshes are .obj, .ply, .gltf, .glb and .fbx"},
                    error.further());
    }
}

/// Checks what the picture would replace; its settings.
RenderSettings check_picture(const RenderOptions& options, Scene& scene);

/// The same of the first picture of a scene, which is aimed.
RenderSettings prepare_picture(const RenderOptions& options, Scene& scene);

} // namespace relief::cli
