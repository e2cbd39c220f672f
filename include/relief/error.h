// The one exception type of the library: what went wrong, where (file, object, place), and how to fix it.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace relief {

/// Category of an error; its value is the exit code of the command: failed 1, usage 2, bad_input 3,
/// device_missing 4, out_of_memory 5.
enum class ErrorKind { failed = 1, usage = 2, bad_input = 3, device_missing = 4, out_of_memory = 5 };

/// `what()` reads "WHERE: MESSAGE (HINT)"; the parts are available separately for programs that format their
/// own text.
class Error : public std::runtime_error {
  public:
    struct Parts {
        std::string message; ///< what is wrong, one sentence without a full stop
        std::string where;   ///< file, line and column, object or pixel; may be empty
        std::string hint;    ///< what the user can do; may be empty
    };

    /// `further`: mistakes that were found together with the first, of independent places.
    Error(ErrorKind kind, Parts parts, std::vector<Parts> further = {})
        : std::runtime_error(describe(parts)),
          kind_(kind),
          parts_(std::move(parts)),
          further_(std::move(further)) {}

    ErrorKind kind() const { return kind_; }
    const std::string& message() const { return parts_.message; }
    const std::string& where() const { return parts_.where; }
    const std::string& hint() const { return parts_.hint; }
    const std::vector<Parts>& further() const { return further_; }

    /// "WHERE: MESSAGE (HINT)"
    static std::string describe(const Parts& parts) {
        std::string text = parts.where.empty() ? parts.message : parts.where + ": " + parts.message;
        return parts.hint.empty() ? text : text + " (" + parts.hint + ")";
    }

  private:
    ErrorKind kind_;
    Parts parts_;
    std::vector<Parts> further_;
};

} // namespace relief
