// What the 'uri' of a glTF buffer may be: data in base64, or the path of a file beside it.
#pragma once

#include <string>
#include <string_view>

namespace relief {

bool is_data_uri(std::string_view uri);

/// Bytes of "data:KIND;base64,TEXT" (RFC 2397, RFC 4648). Throws bad_input.
std::string decode_data_uri(std::string_view uri);

/// A relative path with its percent codes resolved (RFC 3986). Throws bad_input for one that leads out of
/// the folder, so that no file can make the reader open others.
std::string decode_path_uri(std::string_view uri);

} // namespace relief
