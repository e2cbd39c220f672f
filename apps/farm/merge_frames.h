// Frames from the films of their tasks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/progress.h"
#include "farm/job.h"
#include "farm/job_states.h"

namespace relief::cli {

struct MergeOptions {
    std::vector<int> frames;    ///< empty: all
    int threads = 0;            ///< 0: as the job says
    bool removes_parts = false; ///< of frames that are written
    ProgressOptions progress;
};

struct MergeReport {
    size_t written = 0, kept = 0;  ///< frames
    std::vector<uint32_t> corrupt; ///< tasks whose films turned out to be damaged
    std::vector<size_t> missing;   ///< indices of frames that lack something, in rising order
    int exit_code = 0;             ///< of the first frame that was not written as it should
};

/// Writes all frames whose tasks are done and that were not written since. A task whose film is damaged
/// counts as not done from then on. Throws Error for what keeps all frames from being written.
MergeReport merge_frames(const FarmJob& job, const MergeOptions& options);

/// What keeps a frame from being whole: "tile 2/4, samples 0:16 (task 9): failed", and so on; a few of many.
std::string describe_missing(const FarmJob& job, const JobStates& states, size_t frame_index);

/// A frame counts as written until one of its tasks is put up again.
bool is_frame_written(const FarmJob& job, size_t frame_index);
void forget_written_frame(const FarmJob& job, size_t frame_index);
/// Indices of all frames that were written.
std::vector<bool> list_written_frames(const FarmJob& job);

} // namespace relief::cli
