// One picture of what is there of a job: small frames side by side.
#pragma once

#include "farm/job.h"
#include "farm/job_states.h"
#include "relief/image.h"

namespace relief::cli {

inline constexpr size_t kMostSheetFrames = 100;

/// Frames of the job, at most kMostSheetFrames of them, evenly chosen, in rows; what is not rendered is grey.
Image make_sheet(const FarmJob& job, const JobStates& states);

} // namespace relief::cli
