#include "bvh/bvh.h"

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

void check_primitive_count(uint64_t count, uint64_t most, const char* tree, const char* hint) {
    if (count > most)
        throw Error(ErrorKind::out_of_memory,
                    {fmt::format("{} primitives are too many, room is for {}", count, most), tree, hint});
}

} // namespace relief
