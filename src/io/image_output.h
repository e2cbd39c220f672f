// Writing pixels through OpenImageIO with every disk error noticed.
#pragma once

#include <filesystem>

#include <OpenImageIO/imageio.h>

namespace relief {

/// Writes one image of the named OpenImageIO format ("openexr", "png", "hdr") atomically. `pixels` are
/// interleaved samples of `type`. Throws Error{failed}; nothing is left behind then.
void write_pixels(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec,
                  const OIIO::TypeDesc& type, const void* pixels);

} // namespace relief
