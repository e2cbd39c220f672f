#include "viewer/browser_connection.h"

#include <array>
#include <cerrno>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

namespace relief::viewer {

namespace {

constexpr int kRequestSeconds = 10;           ///< that a request may take
constexpr size_t kMostWaitingBytes = 1 << 20; ///< that have come and were not worked on

bool can_continue() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

} // namespace

BrowserConnection::BrowserConnection(int socket) : socket_(socket) { change(State::asking, kRequestSeconds); }

BrowserConnection::~BrowserConnection() { ::close(socket_); }

bool BrowserConnection::is_over(BrowserClock::time_point now) const { return now > deadline_; }

void BrowserConnection::shut() {
    constexpr int kGoodbyeSeconds = 1;
    is_shut_ = true;
    ::shutdown(socket_, SHUT_WR);
    change(State::sending, kGoodbyeSeconds);
}

bool BrowserConnection::read() {
    std::array<char, 16384> block;
    const ssize_t count = ::recv(socket_, block.data(), block.size(), 0);
    if (count < 0) return can_continue();
    if (!is_ended_) input.append(block.data(), size_t(count));
    return count > 0 && input.size() <= kMostWaitingBytes;
}

bool BrowserConnection::send() {
    while (!output_.empty()) {
        const ssize_t count = ::send(socket_, output_.data(), output_.size(), MSG_NOSIGNAL);
        if (count < 0) return can_continue();
        output_.erase(0, size_t(count));
    }
    while (body_ && sent_ < body_->size()) {
        const ssize_t count = ::send(socket_, body_->data() + sent_, body_->size() - sent_, MSG_NOSIGNAL);
        if (count < 0) return can_continue();
        sent_ += size_t(count);
    }
    if (is_ended_ && !is_shut_) shut();
    return true;
}

void BrowserConnection::answer(const std::string& lines, std::shared_ptr<const std::vector<uint8_t>> body) {
    constexpr int kSendSeconds = 30;
    add_output(lines);
    if (!is_head) body_ = std::move(body);
    change(State::sending, kSendSeconds);
    end();
}

void BrowserConnection::change(State next, int seconds) {
    state = next;
    deadline_ =
        seconds > 0 ? BrowserClock::now() + std::chrono::seconds(seconds) : BrowserClock::time_point::max();
}

} // namespace relief::viewer
