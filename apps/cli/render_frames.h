// The frames of a shot: one picture each, with motion blur where the shutter of the camera is open.
#pragma once

#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include "finish_picture.h"
#include "relief/scene.h"
#include "relief/shot.h"

namespace relief::cli {

/// What is done with the scene of each frame before it is rendered.
struct FrameSource {
    Shot& shot;
    std::function<std::pair<Scene, RenderSettings>(int frame)> load;
    /// Checks a scene that differs from the one before, and returns the settings of its picture.
    std::function<RenderSettings(Scene& scene)> check;
};

/// Whether the name holds a place for the number of a frame: `####`.
bool is_frame_pattern(const std::filesystem::path& file);

/// Throws Error{usage} where one of several frames would have the name `pattern` itself: "shot.0003.exr".
void check_frame_names(const std::filesystem::path& pattern, const std::vector<int>& frames);

/// One picture a frame. What does not differ from the frame before stays prepared.
int render_frames(const RenderOptions& options, const FrameSource& source, const std::vector<int>& frames,
                  PendingTimes waiting);

} // namespace relief::cli
