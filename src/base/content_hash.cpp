#include "base/content_hash.h"

#define XXH_INLINE_ALL // headers only, nothing to link
#include <xxhash.h>

namespace relief {

void ContentHash::add_bytes(const void* data, size_t size) {
    state_ = XXH3_64bits_withSeed(data, size, state_);
}

} // namespace relief
