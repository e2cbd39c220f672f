// What readers and writers of EXR files share.
#pragma once

#include <string>

namespace relief {

/// The name in Image::metadata of a text of an EXR header; empty for those that describe the file.
std::string get_metadata_name(const std::string& attribute);
/// And back; empty for those that describe the file.
std::string get_attribute_name(const std::string& metadata);

/// Lets OpenEXR code with all cores; it has one pool for the process. For any thread.
void use_threads_of_exr();

} // namespace relief
