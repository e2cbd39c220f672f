#include "bench/error_curve.h"

#include <cmath>

#include "bench/picture_channels.h"
#include "relief/error.h"

namespace relief::bench {

namespace {

constexpr double kFloor = 0.01; ///< keeps dark pixels from counting without end

double interpolate_seconds(const ErrorPoint& worse, const ErrorPoint& better, double error) {
    const double share = std::log(error / worse.error) / std::log(better.error / worse.error);
    return worse.seconds * std::pow(better.seconds / worse.seconds, share);
}

} // namespace

double compute_relative_error(const Image& picture, const Image& reference) {
    if (picture.width != reference.width || picture.height != reference.height)
        throw Error(ErrorKind::failed, {"the pictures differ in size", "relative error", ""});
    double sum = 0;
    for (const char* name : {"R", "G", "B"}) {
        const size_t a = find_channel(picture, name), b = find_channel(reference, name);
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                const double right = double(reference.at(x, y, b));
                const double difference = double(picture.at(x, y, a)) - right;
                sum += difference * difference / (right * right + kFloor);
            }
    }
    return sum / (3.0 * double(picture.width) * double(picture.height));
}

std::optional<double> find_seconds(std::span<const ErrorPoint> curve, double error) {
    for (size_t k = 0; k < curve.size(); ++k) {
        if (curve[k].error > error) continue;
        return k == 0 ? curve[0].seconds : interpolate_seconds(curve[k - 1], curve[k], error);
    }
    return {};
}

} // namespace relief::bench
