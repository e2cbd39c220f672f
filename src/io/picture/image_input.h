// Opening pictures, guarded against absurd headers.
#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"
#include "relief/io.h"

namespace relief {

/// Throws Error{bad_input}: missing or unreadable file, unknown kind, no pixels, more than 65536 a side or
/// 2^31 texels, or a header that claims far more pixels than the file can hold; Error{failed} where the
/// picture takes the module relief_pictures and that is missing; std::bad_alloc.
std::unique_ptr<PixelSource> open_image(const std::filesystem::path& file);
/// The same for the bytes of a file, which must outlive the source; the extension of `name` tells the kind.
std::unique_ptr<PixelSource> open_image_bytes(std::string_view bytes, const std::string& name);

/// The layer of a picture that its name means, as read_texture reads it, and what was noticed. Throws as
/// open_image, and Error{bad_input} for a layer or part that is not there.
std::unique_ptr<PixelSource> open_texture(const PictureName& name, PictureRemarks& remarks);
/// The same for the bytes of a file, which must outlive the source.
std::unique_ptr<PixelSource> open_texture_bytes(std::string_view bytes, const std::string& name,
                                                PictureRemarks& remarks);

/// read_texture for the bytes of a file; throws as it does.
Texture parse_texture(std::string_view bytes, const std::string& name);

/// What a file's chunks or attributes say of its values being colours, without guesses by format; or empty.
std::string find_color_tag(std::istream& stream);

/// True where the display window is at most four times as wide and high as the pixels, which textures fill.
bool has_near_display(const PixelHeader& header);

} // namespace relief
