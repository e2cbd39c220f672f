// Denoising of finished pictures by Open Image Denoise 2 (Intel), which is loaded at run time: Relief neither
// needs it to be built nor brings it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/image.h"

namespace relief {

/// Albedo and normal of what is seen, also in mirrors and through clear glass, as ImageSettings::layers names
/// them.
inline constexpr const char* kDenoiserGuides[] = {"guide_albedo", "guide_N"};
/// Of the colour, what comes straight from lights to the first surface, or to the camera.
inline constexpr const char* kDirectLayer = "direct";
/// What a picture needs to be denoised.
inline constexpr const char* kDenoiserLayers[] = {kDenoiserGuides[0], kDenoiserGuides[1], kDirectLayer};

struct DenoiserSettings {
    /// Tried in order: shared libraries, or folders that hold libOpenImageDenoise.so.2; then that name on the
    /// path of the system's loader.
    std::vector<std::filesystem::path> libraries;
    int threads = 0; ///< [0, kMaxThreads]; 0: all cores
};

/// The library, loaded, and its CPU device. Movable; a call at a time.
class Denoiser {
  public:
    /// Throws Error{device_missing} where no library can be loaded, or one of another major version is there.
    explicit Denoiser(const DenoiserSettings& settings = {});
    ~Denoiser();
    Denoiser(Denoiser&&) noexcept;
    Denoiser& operator=(Denoiser&&) noexcept;

    std::string version() const; ///< "2.5.1"

    /// Replaces R, G and B of a linear picture, its direct light ("direct.R/G/B") and the rest apart, guided
    /// by "guide_albedo.R/G/B" and "guide_N.X/Y/Z", which are prefiltered first; the colour that was there
    /// goes into the layers "noisy.R/G/B", other channels stay. `is_cancelled` may be empty; where it returns
    /// true the picture stays as it was, and false comes back. Throws Error{bad_input} for a picture without
    /// these channels, Error{out_of_memory}, and Error{failed} where the library fails.
    bool denoise(Image& picture, const std::function<bool()>& is_cancelled = {}) const;

    /// How long denoise() will take for a picture of so many pixels: by the last one, or else by small
    /// ones, which take a few tenths of a second. Throws as denoise().
    double estimate_seconds(size_t pixel_count) const;

  private:
    bool filter_picture(Image& picture, const std::function<bool()>& is_cancelled) const;
    double time_filter(int edge) const;

    struct Library;
    std::unique_ptr<Library> library_;
};

} // namespace relief
