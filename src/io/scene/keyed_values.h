// Values of a scene file that change from frame to frame: {"keys": [[frame, value], ...]} in place of a
// value, and numbers of frames in names of files.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/scene/json_node.h"

namespace relief {

/// Whether anything in the document depends on the frame.
bool is_animated(const Json& document);

/// The same of a value that stands under a key.
bool depends_on_frame(const Json& value, std::string_view key);

/// Whether a value is keys in its place.
bool has_keys(const Json& value);

/// Throws Error{usage} beyond kMaxFrame (relief/shot.h).
void check_frame(double frame);

/// The document as it is at a frame, which may lie between two. Numbers and arrays of them are interpolated
/// linearly, "smooth" or not at all, "step"; all else has steps. Outside its keys a value stays that of the
/// nearest. `rotate_degrees` of transforms turns about one axis where only one angle changes, full turns
/// included, and else the shortest way (Shoemake 1985). Throws Error{bad_input} with `file` and place.
Json evaluate_frame(const Json& document, double frame, const std::string& file);

/// `shape`: the map of a displacement or the file of a mesh; `other`: all else.
enum class FileUse { shape, other };

/// The name at a frame of a file that is called by a name with `####`.
using NameFile = std::function<std::string(const std::string& pattern, double frame, FileUse use)>;

/// When, and for messages in what file.
struct Moment {
    double frame;
    const std::string& file;
    const NameFile* name_file = nullptr; ///< null: fill_frame_number
};

/// The value at `path` of a document ("materials.clay", "objects[3]") as it is at a frame.
Json evaluate_value(const Json& value, const std::string& path, const Moment& moment);

/// The value without the keys that no frame of [low, high] depends on.
Json trim_keys(const Json& value, double low, double high);

/// Names of files in the document, as they stand.
std::vector<std::string> list_file_names(const Json& document);

/// `####` in a name becomes the whole part of `frame` with at least as many digits, everywhere; single `#`
/// stay.
std::string fill_frame_number(const std::string& name, double frame);

} // namespace relief
