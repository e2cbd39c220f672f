// Mistakes in independent parts of a file, told together.
#pragma once

#include <vector>

#include "relief/error.h"

namespace relief {

/// Collects the first few; after that many, the rest of the file is not read.
class ErrorList {
  public:
    /// Calls `read`; keeps an Error{bad_input} of it. Throws all that were kept when there are enough.
    template <class Read> void attempt(const Read& read) {
        try {
            read();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::bad_input) throw;
            errors_.push_back({error.message(), error.where(), error.hint()});
            if (errors_.size() == kMost) throw_all();
        }
    }
    void throw_if_any() const {
        if (!errors_.empty()) throw_all();
    }

  private:
    static constexpr size_t kMost = 10;

    [[noreturn]] void throw_all() const {
        throw Error(ErrorKind::bad_input, errors_.front(), {errors_.begin() + 1, errors_.end()});
    }

    std::vector<Error::Parts> errors_;
};

} // namespace relief
