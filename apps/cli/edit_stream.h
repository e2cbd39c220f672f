// Edits of displacement maps as lines of text, one JSON object a line:
//   {"displacement": "skin", "tile": 1001, "at": [column, row], "texels": "part.exr", "output": "next.exr"}
// `displacement` is optional if the scene has only one, `tile` if it is 1001, `output` if no picture is
// needed yet. Paths are relative to the working directory.
#pragma once

#include <filesystem>
#include <istream>
#include <optional>
#include <string>

#include "relief/error.h"
#include "relief/session.h"

namespace relief::cli {

struct EditLine {
    MapEdit edit;
    std::filesystem::path output; ///< empty: no picture yet
    double read_s = 0;            ///< from the arrival of the line
};

/// Reads edits as they arrive. Errors name `source` and the line.
class EditStream {
  public:
    /// `only_displacement`: name of the scene's displacement, if it has exactly one. The stream must outlive
    /// this object.
    EditStream(std::istream& lines, std::string source, std::string only_displacement);

    /// The next edit with its texels; nullopt at the end. Throws Error{bad_input}, and as read_texture.
    std::optional<EditLine> next();

    /// Calls `body`; adds the position of the last line to its Errors.
    template <class Body> void with_place(const Body& body) const {
        try {
            body();
        } catch (const Error& error) {
            throw Error(error.kind(), {error.message(), get_place(error.where()), error.hint()});
        }
    }

  private:
    EditLine parse(const std::string& text) const;
    std::string get_place(const std::string& detail) const;

    std::istream& lines_;
    std::string source_, only_displacement_;
    size_t line_ = 0;
};

} // namespace relief::cli
