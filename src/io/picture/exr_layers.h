// Layers and parts of EXR files: what there is, and which one a map or texture is read from.
#pragma once

#include <functional>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"
#include "relief/io.h"

namespace relief {

/// Channels of a layer, without its name, in the order in which a map reads them: R G B A, X Y Z, T B N or
/// U V W, whichever has most of them, in any case; then the others by name. `known`: how many come first.
std::vector<std::string> order_layer(std::vector<std::string> channels, size_t& known);

/// The parts of an EXR stream. Throws Error{bad_input} for a damaged header.
std::vector<PicturePart> list_exr_parts(std::unique_ptr<std::istream> stream, const std::string& name);

/// The layer of an EXR file that `choice` names; else the RGB channels of the first part, or the first layer
/// that there is, with a remark about those that are left out. Nothing where the stream is no EXR. `open`
/// opens the file. Throws Error{bad_input} as open_image, and for a layer or part that is not there.
std::unique_ptr<PixelSource> open_exr_layer(const std::function<std::unique_ptr<std::istream>()>& open,
                                            const PictureName& choice, PictureRemarks& remarks);

} // namespace relief
