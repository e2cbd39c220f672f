#include "farm/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "farm/attempts.h"
#include "farm/job_file.h"
#include "farm/preview.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

constexpr int kGap = 4;           ///< pixels between two frames
constexpr float kMissing = 0.05f; ///< linear grey

/// A frame from the previews of its tasks, whose ranges of samples weigh as much as they have.
class SmallFrame {
  public:
    SmallFrame(int width, int height)
        : width_(width),
          height_(height),
          sums_(3 * size_t(width) * size_t(height)),
          weights_(size_t(width) * size_t(height)) {}

    void add(const Image& preview, double weight) {
        const int y1 = std::min(preview.y0 + preview.height, height_);
        const int x1 = std::min(preview.x0 + preview.width, width_);
        for (int y = std::max(0, preview.y0); y < y1; ++y)
            for (int x = std::max(0, preview.x0); x < x1; ++x) {
                const size_t pixel = size_t(y) * size_t(width_) + size_t(x);
                weights_[pixel] += weight;
                for (size_t c = 0; c < 3; ++c) sums_[3 * pixel + c] += weight * double(preview.at(x, y, c));
            }
    }

    void draw(Image& sheet, int left, int top) const {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const size_t pixel = size_t(y) * size_t(width_) + size_t(x);
                for (size_t c = 0; c < 3; ++c)
                    sheet.at(left + x, top + y, c) =
                        weights_[pixel] > 0 ? float(sums_[3 * pixel + c] / weights_[pixel]) : kMissing;
            }
    }

  private:
    int width_, height_;
    std::vector<double> sums_, weights_;
};

void add_task(const FarmJob& job, uint32_t index, SmallFrame& frame) {
    const std::filesystem::path file = get_preview_file(job, index);
    std::error_code code;
    if (!std::filesystem::exists(file, code)) return; // a band of less than a row
    try {
        check_job_file(job, file);
        const FarmTask task = find_task(job, index);
        const Image preview = read_image(file);
        if (preview.channels.size() == 3) frame.add(preview, task.samples.second - task.samples.first);
    } catch (const Error&) {
        return; // a sheet shows what can be read
    }
}

} // namespace

Image make_sheet(const FarmJob& job, const JobStates& states) {
    const int scale = get_preview_scale(job);
    const int width = (job.width + scale - 1) / scale, height = (job.height + scale - 1) / scale;
    const size_t count = std::min(job.frames.size(), kMostSheetFrames);
    const int columns = int(std::ceil(std::sqrt(double(count))));
    const int rows = int((count + size_t(columns) - 1) / size_t(columns));
    Image sheet;
    sheet.width = sheet.full_width = columns * (width + kGap) + kGap;
    sheet.height = sheet.full_height = rows * (height + kGap) + kGap;
    sheet.channels = {"R", "G", "B"};
    sheet.pixels.resize(3 * size_t(sheet.width) * size_t(sheet.height));
    for (size_t k = 0; k < count; ++k) {
        const size_t frame_index = k * job.frames.size() / count;
        SmallFrame frame(width, height);
        for (uint32_t part = 0; part < job.tasks_a_frame(); ++part) {
            const uint32_t task = uint32_t(frame_index) * job.tasks_a_frame() + part;
            if (states.tasks[task] == TaskState::done) add_task(job, task, frame);
        }
        frame.draw(sheet, kGap + int(k) % columns * (width + kGap),
                   kGap + int(k) / columns * (height + kGap));
    }
    return sheet;
}

} // namespace relief::cli
