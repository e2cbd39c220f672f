// Sums of samples, pixel by pixel, and the layers made from them.
#pragma once

#include <iosfwd>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "film/matte_counts.h"
#include "film/sample_batches.h"
#include "image/light_layers.h"
#include "relief/image.h"
#include "relief/render.h"

namespace relief {

/// What one camera sample saw. All but radiance, cost and shadow describe the first hit.
struct FilmSample {
    Vec3f radiance{};
    float alpha = 0; ///< 1 where the camera ray hit a surface, or met a light that it sees
    float depth = std::numeric_limits<float>::infinity();
    Vec3f shading_normal{}, geometric_normal{}, position{}, albedo{};
    Vec2f uv{};
    uint32_t id = 0; ///< 1 + instance; 0: background
    float cost = 0;  ///< rays traced for this sample
    Vec3f shadow{};  ///< 1 where the camera ray met a shadow catcher; its light straight from lights as it
                     ///< arrives, and if nothing were in its way
};

/// The same, summed over several samples of one pixel.
struct FilmSums {
    uint32_t count = 0;       ///< samples
    uint32_t hit_count = 0;   ///< of them, those whose camera ray hit a surface
    uint32_t light_count = 0; ///< of them, those that hit none, but met a light that they see
    Vec3f radiance{};
    Vec3<double> squares{}; ///< of radiance
    float cost = 0;
    Vec3f shading_normal{}, geometric_normal{}, position{}, albedo{};
    Vec2f uv{};
    Vec3f shadow{};
    float depth = std::numeric_limits<float>::infinity(); ///< the least
    uint32_t id = 0; ///< at that depth, the lowest among equals; 0: no hit
    /// Of each sample that hit, in their order; only a film that needs_hit_ids() asks for them.
    std::span<const uint32_t> hit_ids{};
};

/// Where the picture's camera is in the world: what layers are measured from or along.
struct PictureSpace {
    Vec3f origin{}; ///< what positions were measured from
    Vec3f right{1, 0, 0}, up{0, 1, 0},
        back{0, 0, 1}; ///< the camera's axes, orthonormal; `back` is to the viewer
};

/// What the instances of a scene are in the Cryptomatte layers of a picture.
struct InstanceMattes {
    std::vector<uint32_t> objects, materials; ///< make_matte_id() of the name of each instance's object, ...
    std::map<std::string, std::string> entries; ///< what the header of the picture says of them
};

/// Whether one of the layers is of Cryptomatte.
bool needs_mattes(const std::vector<std::string>& layers);

/// How far the passes over a picture are (engine/sample_plan.h).
struct PassState {
    int target = 0;                 ///< samples of each active pixel at the end of the current pass
    std::vector<uint8_t> is_active; ///< blocks that take part in it; empty: all
};

/// Of render_moving(); see ImageSettings::layers.
inline constexpr const char* kMotionLayer = "motion";

enum class ErrorEstimate { off, on };

/// Accumulates in the order of the calls: one pixel must be fed by one thread at a time, samples in rising
/// order. Different pixels may be fed at the same time.
class Film {
  public:
    /// `layers`: names of the table of layers, "depth", "N", ...; throws Error{usage} for an unknown one,
    /// Error{out_of_memory} when the sums and the resolved image do not fit into the memory that is free.
    Film(int full_width, int full_height, const Window& window, const std::vector<std::string>& layers,
         ErrorEstimate error = ErrorEstimate::off);

    const Window& window() const { return window_; }
    /// Before the first sample of a film with Cryptomatte layers.
    void name_instances(std::shared_ptr<const InstanceMattes> mattes) { mattes_ = std::move(mattes); }
    /// Whether sums of surfaces that camera rays met matter, and not only the light of samples and whether
    /// they hit.
    bool needs_surface_sums() const;
    bool needs_hit_ids() const { return objects_ || materials_; }
    /// (x, y) in pixels of the whole picture, inside the window.
    void add_sample(int x, int y, const FilmSample& sample);
    /// As many samples at once as `sums` holds.
    void add_sums(int x, int y, const FilmSums& sums);
    /// Of as many samples as were added, once for each: a colour for each kind and group of light_layers(),
    /// and its guides.
    void add_lights(int x, int y, std::span<const Vec3f> lights);
    const LightLayers& light_layers() const { return light_layers_; }

    /// The layer motion: one a pixel of the window, row by row; without, nothing has moved.
    void set_motions(std::vector<Vec2f> motions);

    /// Adds all samples of a film of the same layers whose window lies in that of this one. Its samples
    /// follow the first `before` of each of its pixels; throws Error{bad_input} where this film has another
    /// number. With ErrorEstimate::on `before` has to be a multiple of 64.
    void join(const Film& part, uint32_t before);

    /// As if the pixels of `window` had never got a sample.
    void clear(const Window& window);

    /// R G B A and the layers, of which motion is as it was set. Colour, alpha, light, guides, N, Ng, P,
    /// albedo, uv and cost are means over the samples (normals normalised again, P and uv over the samples
    /// that hit); depth and id are of the nearest first hit; variance is that of the mean; mattes are shares
    /// of the samples. Pixels without samples are 0, depth infinity. With the layer shadow, alpha holds what
    /// is missing of the light of shadow catchers.
    Image resolve(const PictureSpace& space = {}) const;

    /// The least and the greatest number of samples that a pixel has.
    uint32_t least_samples() const;
    uint32_t most_samples() const;
    uint32_t sample_count(int x, int y) const { return counts_[pixel_index(x, y)]; }

    /// Root mean square over the pixels of a window of the standard error of their colour, relative to it.
    /// With ErrorEstimate::on; infinity where a pixel has fewer than two samples. From 64 samples on it is
    /// told from the means of batches.
    double estimate_error(const Window& window) const;

    PassState passes;

    /// The sums, as bytes that read() of a film of the same window and layers takes; `identity` names the
    /// picture. The stream's state says whether they were written.
    void write(std::ostream& stream, const std::string& identity) const;
    /// Throws Error{bad_input} for bytes of another picture or layers, or that are damaged; the film is then
    /// undefined.
    void read(std::istream& stream, const std::string& identity);

    size_t byte_count() const;

  private:
    size_t pixel_index(int x, int y) const;
    void add_color(int x, int y, const FilmSample& sample);
    void add(int x, int y, const FilmSums& added, float alpha);
    void add_nearest(size_t pixel, float depth, uint32_t id);
    void add_mattes(size_t pixel, std::span<const uint32_t> hit_ids);
    double estimate_variance(size_t pixel) const;

    int full_width_, full_height_;
    Window window_;
    struct Layer {
        size_t kind;       ///< index into the table of layers
        size_t sum_offset; ///< of its first sum within a pixel's stride
        bool is_hidden;    ///< kept for estimate_error() alone
        size_t light = 0;  ///< which colour of add_lights(), if it is one
    };

    void add_layer(const Layer& layer);
    void allocate_sums(ErrorEstimate error);
    std::vector<std::string> name_channels(const Layer& layer) const;
    void write_layer(size_t pixel, const Layer& layer, const PictureSpace& space, float* target) const;

    LightLayers light_layers_;
    std::vector<Layer> layers_;            ///< requested or needed, in the order of that table
    std::optional<size_t> squares_offset_; ///< of the sums of the variance layer
    std::optional<size_t> shadow_offset_;  ///< of those of the shadow layer
    size_t stride_ = 0;
    std::vector<double> sums_;         ///< radiance, alpha, then the sums of the layers: stride_ a pixel
    std::vector<uint32_t> counts_;     ///< samples a pixel
    std::vector<uint32_t> hit_counts_; ///< samples a pixel that hit; empty unless P or uv is requested
    std::vector<float> depths_;        ///< nearest first hit; empty unless depth or id is requested
    std::vector<uint32_t> ids_;
    std::vector<Vec2f> motions_;
    std::shared_ptr<const InstanceMattes> mattes_;
    std::optional<MatteCounts> objects_, materials_; ///< where these layers are requested
    std::optional<SampleBatches> batches_;           ///< with ErrorEstimate::on
};

} // namespace relief
