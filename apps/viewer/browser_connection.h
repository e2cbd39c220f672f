// One connection of a browser: bytes that came, what it waits for, bytes that are to go. Nothing here waits.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viewer/input_event.h"

namespace relief::viewer {

using BrowserClock = std::chrono::steady_clock;

class BrowserConnection {
  public:
    enum class State {
        asking,   ///< its request is not whole yet
        waiting,  ///< for a picture that is newer than `after`
        sending,  ///< its answer; it ends with that
        listening ///< a WebSocket: events come
    };

    /// Takes over the socket, which must not block.
    explicit BrowserConnection(int socket);
    ~BrowserConnection();
    BrowserConnection(const BrowserConnection&) = delete;
    BrowserConnection& operator=(const BrowserConnection&) = delete;

    int socket() const { return socket_; }
    bool has_output() const { return !output_.empty() || (body_ && sent_ < body_->size()); }
    /// Its time is over. An answer that was sent waits a moment for the other side to go: closing a socket
    /// that has bytes left to be read would take the answer back.
    bool is_over(BrowserClock::time_point now) const;

    /// Takes what has come. False: the other side has gone.
    bool read();
    /// Sends as much as goes now. False: the other side has gone.
    bool send();
    /// Puts bytes behind those that are to go.
    void add_output(const std::string& bytes) { output_ += bytes; }
    /// The last answer: lines, and a body that several connections may share.
    void answer(const std::string& lines, std::shared_ptr<const std::vector<uint8_t>> body);
    /// From now on in this state, until so many seconds from now; 0: for ever.
    void change(State state, int seconds);
    /// Ends when all bytes are sent.
    void end() { is_ended_ = true; }

    State state = State::asking;
    BrowserClock::time_point begin = BrowserClock::now();
    std::string input;
    std::string after;                ///< version of the picture that the browser has
    bool is_head = false;             ///< only the lines of the answer are wanted
    std::string message;              ///< frames of a message that is not whole yet
    std::vector<InputEvent> releases; ///< of the buttons that the page holds

  private:
    void shut();

    int socket_;
    std::string output_;
    std::shared_ptr<const std::vector<uint8_t>> body_;
    size_t sent_ = 0; ///< bytes of the body
    bool is_ended_ = false, is_shut_ = false;
    BrowserClock::time_point deadline_;
};

} // namespace relief::viewer
