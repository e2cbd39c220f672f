#include "viewer/browser_server.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <iterator>
#include <list>
#include <mutex>
#include <optional>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "relief/error.h"
#include "viewer/browser_connection.h"
#include "viewer/browser_request.h"
#include "viewer/web_socket.h"

namespace relief::viewer {

namespace {

using State = BrowserConnection::State;
using Bytes = std::shared_ptr<const std::vector<uint8_t>>;

constexpr int kPatience =
    10; ///< seconds after which the answer to a browser that waits for a picture is to ask again
constexpr size_t kMostConnections =
    256; ///< one more ends the one that has been silent, or waiting, for longest
constexpr int kRoundMilliseconds = 250; ///< after which deadlines are looked at

std::string make_token() {
    std::random_device random;
    std::string token;
    for (int k = 0; k < 4; ++k) token += fmt::format("{:08x}", random());
    return token;
}

/// A socket at 127.0.0.1. Throws Error{failed} where the port cannot be had.
int listen_at(int port) {
    const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const int on = 1;
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_port = htons(uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (listener >= 0 && ::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
        ::listen(listener, 128) == 0)
        return listener;
    ::close(listener);
    throw Error(ErrorKind::failed, {fmt::format("127.0.0.1:{} cannot be listened on", port), "--serve",
                                    "another program has the port: name another one, or 0 for any"});
}

Bytes make_bytes(std::string_view text) {
    return std::make_shared<const std::vector<uint8_t>>(text.begin(), text.end());
}

std::string make_lines(int status, const char* reason, const char* type, size_t bytes,
                       const std::string& more) {
    return fmt::format(
        "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n"
        "Referrer-Policy: no-referrer\r\nConnection: close\r\n{}\r\n",
        status, reason, type, bytes, more);
}

void refuse(BrowserConnection& connection, const Refusal& refusal) {
    const Bytes body = make_bytes(fmt::format("Error {}: {}\n", refusal.status, refusal.reason));
    connection.answer(make_lines(refusal.status, "Refused", "text/plain", body->size(),
                                 refusal.status == 405 ? "Allow: GET, HEAD\r\n" : ""),
                      body);
}

} // namespace

struct BrowserServer::Implementation {
    std::function<void()> on_events;
    std::string token = make_token();
    int listener = -1, wake = -1;
    std::atomic<bool> is_ending{false};
    std::mutex mutex; ///< of what follows, up to `version`
    std::vector<InputEvent> events;
    Bytes jpeg;
    std::string text;
    uint64_t version = 0;
    std::list<BrowserConnection> connections; ///< of the thread
    std::thread thread;

    ~Implementation() {
        for (const int descriptor : {listener, wake})
            if (descriptor >= 0) ::close(descriptor);
    }

    void ring() const {
        const uint64_t one = 1;
        [[maybe_unused]] const ssize_t written = ::write(wake, &one, sizeof one);
    }

    void run() {
        while (!is_ending) {
            std::vector<pollfd> watched = {{wake, POLLIN, 0}, {listener, POLLIN, 0}};
            for (const BrowserConnection& c : connections)
                watched.push_back({c.socket(), short(c.has_output() ? POLLIN | POLLOUT : POLLIN), 0});
            if (::poll(watched.data(), watched.size(), kRoundMilliseconds) < 0 && errno != EINTR) return;
            if (watched[0].revents != 0) {
                uint64_t count = 0;
                [[maybe_unused]] const ssize_t taken = ::read(wake, &count, sizeof count);
            }
            serve(watched);
            if (watched[1].revents != 0) accept_all();
        }
    }

    /// `watched`: from the third on, in the order of the connections.
    void serve(const std::vector<pollfd>& watched) {
        const BrowserClock::time_point now = BrowserClock::now();
        size_t index = 2;
        for (auto at = connections.begin(); at != connections.end();) {
            BrowserConnection& c = *at;
            const short came = watched[index++].revents;
            bool is_there = (came & (POLLERR | POLLNVAL)) == 0;
            if (is_there && (came & (POLLIN | POLLHUP)) != 0) is_there = c.read();
            if (is_there) work(c);
            if (is_there && c.state == State::waiting && c.is_over(now))
                c.answer("HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n", nullptr);
            if (is_there && c.has_output()) is_there = c.send();
            if (is_there && !c.is_over(now)) {
                ++at;
                continue;
            }
            let_go(c);
            at = connections.erase(at);
        }
    }

    void accept_all() {
        for (;;) {
            const int socket = ::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
            if (socket < 0) return;
            if (connections.size() >= kMostConnections) end_oldest();
            connections.emplace_back(socket);
        }
    }

    /// Ends one connection: without a request if there is one, else one that waits for a picture, else a
    /// page.
    void end_oldest() {
        const auto oldest = std::ranges::min_element(
            connections, {}, [](const BrowserConnection& c) { return std::pair(c.state, c.begin); });
        let_go(*oldest);
        connections.erase(oldest);
    }

    void work(BrowserConnection& c) {
        if (c.state == State::asking) begin_answer(c);
        if (c.state == State::waiting) answer_picture(c);
        if (c.state == State::listening) take_messages(c);
    }

    void begin_answer(BrowserConnection& c) {
        const size_t end = c.input.find("\r\n\r\n");
        if (end == std::string::npos && c.input.size() <= kMostRequestBytes) return;
        const std::optional<BrowserRequest> request =
            end <= kMostRequestBytes ? parse_request(std::string_view(c.input).substr(0, end)) : std::nullopt;
        if (!request) return refuse(c, {400, "this is no request of a browser"});
        c.input.erase(0, end + 4);
        c.is_head = request->method == "HEAD";
        if (const std::optional<Refusal> refusal = refuse_request(*request, token))
            return refuse(c, *refusal);
        if (request->path == "/") {
            const Bytes page = make_bytes(kBrowserPage);
            return c.answer(make_lines(200, "OK", "text/html", page->size(), ""), page);
        }
        if (request->path == "/picture") {
            c.after = request->variable("after");
            return c.change(State::waiting, kPatience);
        }
        if (request->path != "/events") return refuse(c, {404, "there is no such page"});
        open_events(c, *request);
    }

    void open_events(BrowserConnection& c, const BrowserRequest& request) {
        const std::string key = request.header("sec-websocket-key");
        if (request.method != "GET" || key.empty()) return refuse(c, {400, "events go by a WebSocket"});
        c.add_output(
            fmt::format("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                        "Sec-WebSocket-Accept: {}\r\n\r\n",
                        make_accept_key(key)));
        c.change(State::listening, 0);
    }

    /// Sends the picture if it is newer than the one that the browser has.
    void answer_picture(BrowserConnection& c) {
        Bytes shown;
        std::string more;
        {
            const std::lock_guard lock(mutex);
            if (!jpeg || std::to_string(version) == c.after) return;
            shown = jpeg;
            more = fmt::format("X-Relief-Version: {}\r\nX-Relief-Text: {}\r\n", version, escape(text));
        }
        c.answer(make_lines(200, "OK", "image/jpeg", shown->size(), more), shown);
    }

    void take_messages(BrowserConnection& c) {
        SocketFrame frame;
        for (;;) {
            const FrameFault fault = read_frame(c.input, frame);
            if (fault == FrameFault::incomplete) return;
            if (fault == FrameFault::none) c.input.erase(0, frame.bytes);
            if (fault == FrameFault::refused || frame.kind == SocketFrame::Kind::close ||
                c.message.size() + frame.content.size() > kMostMessageBytes) {
                c.add_output(make_close());
                return c.end();
            }
            if (frame.kind == SocketFrame::Kind::ping) c.add_output(make_pong(frame.content));
            if (frame.kind != SocketFrame::Kind::text) continue;
            c.message += frame.content;
            if (frame.is_last) receive(c, std::exchange(c.message, {}));
        }
    }

    void receive(BrowserConnection& c, const std::string& message) {
        std::vector<InputEvent> made = parse_browser_event(message);
        if (made.empty()) return;
        for (const InputEvent& event : made) note_buttons(c, event);
        add_events(std::move(made));
    }

    static void note_buttons(BrowserConnection& c, const InputEvent& event) {
        using Kind = InputEvent::Kind;
        if (event.kind != Kind::press && event.kind != Kind::release) return;
        std::erase_if(c.releases, [&](const InputEvent& release) { return release.button == event.button; });
        if (event.kind == Kind::release) return;
        c.releases.push_back(event);
        c.releases.back().kind = Kind::release;
    }

    /// A page that goes away lets go of what it holds.
    void let_go(BrowserConnection& c) {
        if (!c.releases.empty()) add_events(std::move(c.releases));
    }

    void add_events(std::vector<InputEvent> made) {
        {
            const std::lock_guard lock(mutex);
            std::move(made.begin(), made.end(), std::back_inserter(events));
        }
        on_events();
    }
};

BrowserServer::BrowserServer(int port, std::function<void()> on_events)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    self.on_events = std::move(on_events);
    self.listener = listen_at(port);
    self.wake = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (self.wake < 0) throw Error(ErrorKind::failed, {"the system gives no event", "--serve", ""});
    self.thread = std::thread([&self] { self.run(); });
}

BrowserServer::~BrowserServer() {
    implementation_->is_ending = true;
    implementation_->ring();
    implementation_->thread.join();
}

std::string BrowserServer::url() const {
    sockaddr_in address{};
    socklen_t bytes = sizeof address;
    ::getsockname(implementation_->listener, reinterpret_cast<sockaddr*>(&address), &bytes);
    return fmt::format("http://127.0.0.1:{}/?token={}", ntohs(address.sin_port), implementation_->token);
}

std::vector<InputEvent> BrowserServer::take_events() {
    const std::lock_guard lock(implementation_->mutex);
    return std::exchange(implementation_->events, {});
}

void BrowserServer::show(std::vector<uint8_t> jpeg, std::string text) {
    Implementation& self = *implementation_;
    {
        const std::lock_guard lock(self.mutex);
        self.jpeg = std::make_shared<const std::vector<uint8_t>>(std::move(jpeg));
        self.text = std::move(text);
        ++self.version;
    }
    self.ring();
}

} // namespace relief::viewer
