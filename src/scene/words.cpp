#include "scene/words.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "base/suggest.h"
#include "relief/error.h"

namespace relief {

size_t find_word(const EnumWords& words, std::string_view text) {
    const auto end = std::find(words.words.begin(), words.words.end(), "");
    const std::span<const std::string_view> known(words.words.begin(), end);
    const auto found = std::find(known.begin(), known.end(), text);
    if (found == known.end())
        throw Error(ErrorKind::bad_input,
                    {fmt::format("unknown {} '{}'", words.what, text), "", suggest_word(text, known)});
    return size_t(found - known.begin());
}

} // namespace relief
