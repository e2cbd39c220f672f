// Filters a picture as the library's documentation advises for guides with noise of their own: albedo,
// normals, then the colour with both as clean guides; direct and indirect light apart.
#include "relief/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "base/check.h"
#include "base/timer.h"
#include "denoise/oidn_library.h"
#include "relief/error.h"

namespace relief {

namespace {

using Channels = std::array<const char*, 3>;
constexpr Channels kColor = {"R", "G", "B"}, kNoisy = {"noisy.R", "noisy.G", "noisy.B"};
constexpr Channels kAlbedo = {"guide_albedo.R", "guide_albedo.G", "guide_albedo.B"},
                   kDirect = {"direct.R", "direct.G", "direct.B"},
                   kNormal = {"guide_N.X", "guide_N.Y", "guide_N.Z"};

std::array<size_t, 3> find_channels(const Image& picture, const Channels& names) {
    std::array<size_t, 3> found;
    for (size_t k = 0; k < 3; ++k) {
        const std::optional<size_t> channel = picture.find_channel(names[k]);
        if (!channel)
            throw Error(ErrorKind::bad_input,
                        {fmt::format("a picture without the channel {} cannot be denoised", names[k]), "",
                         "render it with the layers guide_albedo, guide_N and direct"});
        found[k] = *channel;
    }
    return found;
}

/// Interleaved, three floats a pixel. NaN and infinity, of depths alone, do not come here.
std::vector<float> take_channels(const Image& picture, const Channels& names) {
    const std::array<size_t, 3> channels = find_channels(picture, names);
    const size_t width = picture.channels.size(), count = picture.pixels.size() / width;
    std::vector<float> taken(3 * count);
    for (size_t p = 0; p < count; ++p)
        for (size_t k = 0; k < 3; ++k) taken[3 * p + k] = picture.pixels[p * width + channels[k]];
    return taken;
}

/// The rest of a sum, whose parts are not negative.
std::vector<float> subtract(const std::vector<float>& sum, const std::vector<float>& part) {
    std::vector<float> rest(sum.size());
    std::ranges::transform(sum, part, rest.begin(), [](float a, float b) { return std::max(a - b, 0.0f); });
    return rest;
}

void put_channels(const std::vector<float>& values, const std::array<size_t, 3>& channels, Image& picture) {
    const size_t width = picture.channels.size();
    for (size_t p = 0; p < values.size() / 3; ++p)
        for (size_t k = 0; k < 3; ++k) picture.pixels[p * width + channels[k]] = values[3 * p + k];
}

void append_channels(const Channels& names, Image& picture) {
    const size_t before = picture.channels.size(), after = before + names.size();
    std::vector<float> pixels(picture.pixels.size() / before * after);
    for (size_t p = 0; p < pixels.size() / after; ++p)
        std::copy_n(picture.pixels.begin() + ptrdiff_t(p * before), before,
                    pixels.begin() + ptrdiff_t(p * after));
    picture.pixels = std::move(pixels);
    picture.channels.insert(picture.channels.end(), names.begin(), names.end());
}

} // namespace

struct Denoiser::Library {
    oidn::Functions call;
    oidn::Device device = nullptr;
    /// Of a picture: what does not depend on its size, and what one pixel adds; negative: not known.
    double fixed_s = 0, pixel_s = -1;

    explicit Library(const DenoiserSettings& settings) : call(oidn::load_functions(settings.libraries)) {
        device = call.NewDevice(oidn::kDeviceCpu);
        if (device) {
            if (settings.threads > 0) call.SetDeviceInt(device, "numThreads", settings.threads);
            call.CommitDevice(device);
        }
        const char* message = nullptr;
        if (call.GetDeviceError(device, &message) == oidn::kErrorNone && device) return;
        const std::string reason = message ? message : "no device";
        if (device) call.ReleaseDevice(device);
        throw Error(ErrorKind::device_missing,
                    {"the denoiser cannot be started: " + reason, "Open Image Denoise", ""});
    }
    ~Library() { call.ReleaseDevice(device); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    struct Input {
        const char* name;
        std::vector<float>* pixels;
    };

    /// Filters the first input into `output`, which may be its own pixels. False: cancelled.
    bool filter(const std::vector<Input>& inputs, std::vector<float>& output, const Image& picture,
                const std::function<bool()>& is_cancelled) const {
        const auto release = [this](oidn::Filter f) { call.ReleaseFilter(f); };
        const std::unique_ptr<oidn::FilterHandle, decltype(release)> filter(call.NewFilter(device, "RT"),
                                                                            release);
        const auto set_image = [&](const char* name, std::vector<float>& pixels) {
            call.SetSharedFilterImage(filter.get(), name, pixels.data(), oidn::kFormatFloat3,
                                      size_t(picture.width), size_t(picture.height), 0, 0, 0);
        };
        for (const Input& input : inputs) set_image(input.name, *input.pixels);
        set_image("output", output);
        const bool has_guides = inputs.size() > 1;
        if (has_guides) call.SetFilterBool(filter.get(), "hdr", true);
        if (has_guides) call.SetFilterBool(filter.get(), "cleanAux", true);
        const auto goes_on = [](void* user, double) {
            const auto& asked = *static_cast<const std::function<bool()>*>(user);
            return !asked || !asked();
        };
        call.SetFilterProgressMonitorFunction(filter.get(), goes_on,
                                              const_cast<std::function<bool()>*>(&is_cancelled));
        call.CommitFilter(filter.get());
        call.ExecuteFilter(filter.get());
        return check();
    }

    /// False: cancelled. Throws for any other error since the last call.
    bool check() const {
        const char* message = nullptr;
        const int error = call.GetDeviceError(device, &message);
        if (error == oidn::kErrorNone) return true;
        if (error == oidn::kErrorCancelled) return false;
        if (error == oidn::kErrorOutOfMemory)
            throw Error(ErrorKind::out_of_memory, {"the denoiser lacks memory for the picture",
                                                   "Open Image Denoise", "denoise a smaller picture"});
        throw Error(ErrorKind::failed,
                    {std::string("the denoiser failed: ") + (message ? message : "no reason given"),
                     "Open Image Denoise", ""});
    }
};

Denoiser::Denoiser(const DenoiserSettings& settings) : library_(std::make_unique<Library>(settings)) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

std::string Denoiser::version() const {
    const int version = library_->call.GetDeviceInt(library_->device, "version"); // 20501: 2.5.1
    return fmt::format("{}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

/// Seconds of one of the filters for a grey square, the largest one.
double Denoiser::time_filter(int edge) const {
    Image picture;
    picture.width = picture.height = edge;
    std::vector<float> grey(3 * size_t(edge) * size_t(edge), 0.5f), clean(grey.size());
    const Timer timer;
    library_->filter({{"color", &grey}, {"albedo", &grey}, {"normal", &grey}}, clean, picture, {});
    return timer.seconds();
}

double Denoiser::estimate_seconds(size_t pixel_count) const {
    if (library_->pixel_s < 0) {
        constexpr int kSmall = 64, kLarge = 256, kFilters = 4;
        time_filter(kSmall); // the first call starts threads
        const double small_s = time_filter(kSmall), large_s = time_filter(kLarge);
        library_->pixel_s = kFilters * std::max(large_s - small_s, 0.0) / (kLarge * kLarge - kSmall * kSmall);
        library_->fixed_s = kFilters * small_s;
    }
    return library_->fixed_s + library_->pixel_s * double(pixel_count);
}

bool Denoiser::denoise(Image& picture, const std::function<bool()>& is_cancelled) const {
    const Timer timer;
    if (!filter_picture(picture, is_cancelled)) return false;
    const size_t pixels = picture.pixels.size() / picture.channels.size();
    library_->fixed_s = 0, library_->pixel_s = timer.seconds() / double(pixels);
    return true;
}

bool Denoiser::filter_picture(Image& picture, const std::function<bool()>& is_cancelled) const {
    if (picture.find_channel(kNoisy[0]))
        throw Error(ErrorKind::bad_input, {"the picture is denoised already", "", ""});
    const std::array<size_t, 3> color = find_channels(picture, kColor);
    const std::vector<float> noisy = take_channels(picture, kColor);
    std::vector<float> direct = take_channels(picture, kDirect), indirect = subtract(noisy, direct);
    std::vector<float> albedo = take_channels(picture, kAlbedo), normal = take_channels(picture, kNormal);
    const auto filter = [&](std::vector<float>& light) {
        std::vector<float> clean(light.size());
        const bool is_done = library_->filter({{"color", &light}, {"albedo", &albedo}, {"normal", &normal}},
                                              clean, picture, is_cancelled);
        light = std::move(clean);
        return is_done;
    };
    if (!library_->filter({{"albedo", &albedo}}, albedo, picture, is_cancelled) ||
        !library_->filter({{"normal", &normal}}, normal, picture, is_cancelled) || !filter(direct) ||
        !filter(indirect))
        return false;
    std::vector<float> clean(direct.size());
    for (size_t k = 0; k < clean.size(); ++k) clean[k] = direct[k] + indirect[k];
    append_channels(kNoisy, picture);
    put_channels(clean, color, picture);
    put_channels(noisy, find_channels(picture, kNoisy), picture);
    picture.metadata["relief:denoiser"] = "Open Image Denoise " + version();
    return true;
}

} // namespace relief
