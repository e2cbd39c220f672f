// Channels of pictures that a comparison cannot do without.
#pragma once

#include <string>

#include "relief/error.h"
#include "relief/image.h"

namespace relief::bench {

/// Throws Error{failed} where the picture lacks the channel.
inline size_t find_channel(const Image& picture, const std::string& name) {
    const auto channel = picture.find_channel(name);
    if (!channel) throw Error(ErrorKind::failed, {"the picture has no channel " + name, "bench", ""});
    return *channel;
}

} // namespace relief::bench
