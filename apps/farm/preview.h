// Small pictures of what tasks rendered, for the sheet of `farm status`.
#pragma once

#include <vector>

#include "farm/job.h"
#include "relief/image.h"

namespace relief::cli {

inline constexpr int kPreviewWidth = 160; ///< pixels of a whole frame, at most

/// Pixels of a frame that one of its preview is made of, a side.
int get_preview_scale(const FarmJob& job);

/// The preview of a part of a frame: R, G, B; its windows are those of the part, scaled. A band with less
/// than a row has none (height 0).
Image make_preview(const Image& part, int scale);

/// Beside the part; that it cannot be written is no failure of the task.
void write_preview(const FarmJob& job, const FarmTask& task, const Image& part);

} // namespace relief::cli
