// The part of RFC 6455 (The WebSocket Protocol, 2011) that a server of small text messages needs.
#pragma once

#include <optional>
#include <string>

namespace relief::viewer {

inline constexpr size_t kMostMessageBytes = 65536; ///< a longer message ends the connection

/// The value of Sec-WebSocket-Accept for that of Sec-WebSocket-Key (section 4.2.2).
std::string make_accept_key(const std::string& key);

/// A frame holds one message of a browser, or a part of one.
struct SocketFrame {
    enum class Kind { text, ping, close, other };
    Kind kind = Kind::other;
    std::string content;
    size_t bytes = 0; ///< size of the frame in the buffer
    bool is_last = true;
};

enum class FrameFault { none, incomplete, refused };

/// The first frame of the buffer (section 5.2). `incomplete`: more bytes are needed; `refused`: the bytes
/// break the protocol, or the frame is too long.
FrameFault read_frame(const std::string& buffer, SocketFrame& frame);

/// The answer to a ping, and the end of a connection.
std::string make_pong(const std::string& content);
std::string make_close();

} // namespace relief::viewer
