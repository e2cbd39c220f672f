// Colour spaces of textures and pictures by name; everything between is linear Rec.709.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "relief/image.h"
#include "relief/types.h"

namespace relief {

class ColorTransform;

/// Entry of a picture's header: the space in which its file holds colours; linear Rec.709 where it is
/// missing.
inline constexpr const char* kColorSpaceTag = "relief:color_space";

/// Spaces that need no configuration, of textures and of pictures. Textures may also be in a colour space of
/// the OpenColorIO configuration that the environment variable OCIO names.
inline constexpr std::string_view kTextureSpaces[] = {"linear", "srgb", "acescg", "aces2065-1", "acescct"};
inline constexpr std::string_view kPictureSpaces[] = {"linear", "acescg", "aces2065-1"};

/// CIE 1931 xy.
struct Chromaticities {
    Vec2f red, green, blue, white;
};

/// Of one of kPictureSpaces.
Chromaticities find_chromaticities(std::string_view space);

/// Turns the first three channels of all texels into linear Rec.709; alpha stays. Throws Error{bad_input} for
/// a space that is neither known nor in the configuration, Error{failed} where the library of colours cannot
/// be loaded.
void decode_texture(const std::string& space, Texture& texture);

enum class ColorWay { to_file, from_file };

/// Converts the colour channels of a picture between linear Rec.709 and the space that its header names: R,
/// G, B of the picture and of layers, but for variances and Cryptomatte. Throws Error{bad_input} for a space
/// that is not one of kPictureSpaces, Error{failed} as decode_texture.
void convert_picture(ColorWay way, Image& image);

} // namespace relief
