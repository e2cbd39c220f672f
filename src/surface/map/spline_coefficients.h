// From texels to the coefficients of the uniform bicubic B-spline that smooth filters evaluate.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>

#include "relief/scene.h"
#include "surface/map/texel_range.h"

namespace relief {

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

SplineForm make_spline_form(const Displacement& displacement);
/// Of a texture of a material: repeated.
SplineForm make_spline_form(MapFilter filter);

/// Coefficients of the spline, as floats; `texels` itself where the form keeps them. Each depends on the
/// texels near it alone, in a fixed order of operations.
std::shared_ptr<const Texture> make_spline(const std::shared_ptr<const Texture>& texels,
                                           const SplineForm& form);

/// Follows new texels in a rectangle: the same bits as make_spline. Returns which coefficients were made
/// anew.
TexelRectangle update_spline(const Texture& texels, const SplineForm& form, const TexelRectangle& changed,
                             Texture& coefficients);

} // namespace relief
