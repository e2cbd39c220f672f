// From texels to the coefficients of the uniform bicubic B-spline that smooth filters evaluate.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>

#include "relief/scene.h"
#include "surface/map/texel_range.h"
#include "surface/map/tile_index.h"

namespace relief {

struct DisplacementMap;

/// What becomes of the texels of an image.
struct SplineForm {
    bool is_interpolating = false; ///< the spline goes through the texels; else they are its coefficients
    bool is_dequantized = false;   ///< each is moved by up to half a step of its integers before
    WrapMode wrap = WrapMode::clamp;
    std::array<float, 3> outside{}; ///< with WrapMode::black

    /// The coefficients are the texels, as with filters that are not smooth.
    bool keeps_texels() const { return !is_interpolating && !is_dequantized; }
    friend auto operator<=>(const SplineForm&, const SplineForm&) = default;
};

/// Names the tile of `map` that the texels of an image are in. `map` has the texels of all tiles, before they
/// become coefficients, and the neighbours of each.
struct TileSurroundings {
    const DisplacementMap& map;
    TileIndex tile;
};

SplineForm make_spline_form(const Displacement& displacement);
/// Of a texture of a material: repeated.
SplineForm make_spline_form(MapFilter filter);

/// Coefficients of the spline, as floats; `texels` itself where the form keeps them. Each depends on the
/// texels near it alone, in a fixed order of operations.
/// `surroundings`: of a tile that others continue, or null.
std::shared_ptr<const Texture> make_spline(const std::shared_ptr<const Texture>& texels,
                                           const SplineForm& form,
                                           const TileSurroundings* surroundings = nullptr);

/// Follows new texels in a rectangle: the same bits as make_spline. Returns which coefficients were made
/// anew.
TexelRectangle update_spline(const Texture& texels, const SplineForm& form, const TexelRectangle& changed,
                             Texture& coefficients, const TileSurroundings* surroundings = nullptr);

/// The same after `changed` texels of the tile that is `columns` tiles to the right in the image and `rows`
/// below; nothing where they are too far away. The tiles have one size, or all texels are made anew.
std::optional<TexelRectangle> update_spline_beside(const Texture& texels, const SplineForm& form,
                                                   const TexelRectangle& changed, std::array<int, 2> offset,
                                                   Texture& coefficients,
                                                   const TileSurroundings& surroundings);

} // namespace relief
