// Opening pictures through OpenImageIO without any colour or alpha conversion, guarded against absurd
// headers.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "relief/image.h"

namespace relief {

/// An open picture. `proxy` is set for pictures in memory and must outlive `input`.
struct ImageInput {
    std::string name;
    std::unique_ptr<OIIO::Filesystem::IOMemReader> proxy;
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;

    [[noreturn]] void fail(const std::string& message, const std::string& hint) const;
};

/// Throws bad_input: missing or unreadable file, unknown kind, no pixels, more than 65536 a side or 2^31
/// texels, or a header that claims far more pixels than the file can hold.
ImageInput open_image(const std::filesystem::path& file);
/// The same for the bytes of a file; the extension of `name` tells the kind.
ImageInput open_image_bytes(std::string_view bytes, const std::string& name);

/// read_texture for the bytes of a file.
Texture parse_texture(std::string_view bytes, const std::string& name);

/// True where the display window is at most four times as wide and high as the pixels: textures are filled up
/// to it.
bool has_near_display(const OIIO::ImageSpec& spec);

SampleType get_sample_type(const OIIO::TypeDesc& type);

} // namespace relief
