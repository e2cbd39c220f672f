// What the runs of one program say of a frame, and of two programs beside each other.
#pragma once

#include <vector>

#include "bench/frame_program.h"
#include "common/report.h"
#include "relief/image.h"

namespace relief::bench {

/// {version, device, samples_per_s, rays_per_sample, render_s, prepare_s, first_image_s, processor_s,
/// peak_resident_bytes, stages} of at least one run of `samples` samples; all with quartiles but the first
/// two. `stages` has, for each stage that the statistics name, {seconds, share}: `share` of the median of the
/// stage in the sum of those of all. What the statistics lack is null, never 0.
Value describe_frame_runs(const std::vector<FrameRun>& runs, double samples);

/// {ratio, ratio_with_preparation, ratio_by_processor}, with quartiles: of pairs of runs, own[k] with
/// baseline[k], how many times as many samples a second `own` renders; by the time of the render, with that
/// of the preparation, and by the processor time of the whole process. Null where statistics lack the times.
Value compare_frame_runs(const std::vector<FrameRun>& own, const std::vector<FrameRun>& baseline);

/// {brightness_difference, relative_squared_error}: mean of R, G and B of the picture less that of the
/// reference, over the latter (null where it is 0); compute_relative_error. Both have the same size and these
/// channels, or Error{failed} is thrown.
Value compare_frame_pictures(const Image& picture, const Image& reference);

} // namespace relief::bench
