// Names of pictures with the layer or part of an EXR file that is meant.
#include <algorithm>
#include <cctype>

#include "relief/io.h"

namespace relief {

namespace {

constexpr std::string_view kExrEnd = ".exr:";

/// Returns the place of the colon behind the name of an EXR file, or npos where there is none.
size_t find_colon(const std::string& name) {
    const auto found =
        std::search(name.begin(), name.end(), kExrEnd.begin(), kExrEnd.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
    return found == name.end() ? std::string::npos : size_t(found - name.begin()) + kExrEnd.size() - 1;
}

} // namespace

PictureName split_picture_name(const std::string& name) {
    const size_t colon = find_colon(name);
    std::error_code code;
    if (colon == std::string::npos || std::filesystem::exists(name, code)) return {name, "", ""};
    PictureName result{name.substr(0, colon), "", name.substr(colon + 1)};
    if (const size_t second = result.layer.find(':'); second != std::string::npos) {
        result.part = result.layer.substr(0, second);
        result.layer.erase(0, second + 1);
    }
    return result;
}

std::string join_picture_name(const PictureName& name) {
    if (name.part.empty() && name.layer.find(':') == std::string::npos)
        return name.layer.empty() ? name.file : name.file + ":" + name.layer;
    return name.file + ":" + name.part + ":" + name.layer;
}

} // namespace relief
