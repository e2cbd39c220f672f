// Names of texts in EXR files.
#pragma once

#include <string>

namespace relief {

/// The name in Image::metadata of a text of an EXR header; empty for those that describe the file.
std::string get_metadata_name(const std::string& attribute);
/// And back; empty for those that describe the file.
std::string get_attribute_name(const std::string& metadata);

} // namespace relief
