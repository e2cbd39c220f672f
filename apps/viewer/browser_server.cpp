#include "viewer/browser_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <map>
#include <mutex>
#include <random>
#include <string_view>
#include <utility>

#include <civetweb.h>
#include <fmt/format.h>

#include "common/report.h"
#include "relief/error.h"

namespace relief::viewer {

namespace {

/// Seconds after which a browser that waits for a picture is told to ask again.
constexpr int kPatience = 10;
/// Bytes of a message from outside; more is no event.
constexpr size_t kMostBytes = 1024;

std::string make_token() {
    std::random_device random;
    std::string token;
    for (int k = 0; k < 4; ++k) token += fmt::format("{:08x}", random());
    return token;
}

std::string get_variable(const mg_request_info& request, const char* name) {
    const char* const query = request.query_string ? request.query_string : "";
    std::array<char, 128> value{};
    const int length = mg_get_var(query, std::string_view(query).size(), name, value.data(), value.size());
    return length > 0 ? std::string(value.data(), size_t(length)) : std::string();
}

/// Takes as long wherever the first difference is.
bool are_equal(const std::string& a, const std::string& b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) difference |= unsigned(a[k] ^ b[k]);
    return difference == 0;
}

/// For a header: letters and digits as they are, other bytes as %XX.
std::string escape(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        result +=
            is_plain ? std::string(1, c) : fmt::format("%{:02X}", unsigned(static_cast<unsigned char>(c)));
    }
    return result;
}

bool is_true(const Value& event, const char* name) {
    return event.contains(name) && event[name].kind() == Value::Kind::truth && event[name].get<bool>();
}

std::vector<InputEvent> make_browser_event(const Value& event) {
    using Kind = InputEvent::Kind;
    constexpr std::pair<std::string_view, Kind> kKinds[] = {{"press", Kind::press},
                                                            {"move", Kind::move},
                                                            {"release", Kind::release},
                                                            {"scroll", Kind::scroll},
                                                            {"key", Kind::key_down}};
    constexpr std::pair<std::string_view, int> kKeys[] = {{"left", kLeft}, {"right", kRight},  {"up", kUp},
                                                          {"down", kDown}, {"+", '+'},         {"-", '-'},
                                                          {".", '.'},      {"escape", kEscape}};
    InputEvent made;
    const std::string name = event["kind"].get<std::string>();
    const auto* const kind = std::ranges::find(kKinds, name, &std::pair<std::string_view, Kind>::first);
    if (kind == std::end(kKinds)) return {};
    made.kind = kind->second;
    made.x = std::clamp(event["x"].get<float>(), -1.0f, 2.0f);
    made.y = std::clamp(event["y"].get<float>(), -1.0f, 2.0f);
    made.modifiers = {is_true(event, "shift"), is_true(event, "control"), is_true(event, "alt")};
    const int button = event["button"].get<int>();
    made.button = button == 1 ? MouseButton::middle : button == 2 ? MouseButton::right : MouseButton::left;
    if (made.kind == Kind::scroll) made.amount = std::clamp(event["amount"].get<float>(), -10.0f, 10.0f);
    if (made.kind != Kind::key_down) return {made};
    const auto* const key =
        std::ranges::find(kKeys, event["key"].get<std::string>(), &std::pair<std::string_view, int>::first);
    if (key == std::end(kKeys)) return {};
    made.key = key->second;
    made.is_repeat = is_true(event, "repeat");
    InputEvent released = made;
    released.kind = Kind::key_up;
    return {made, released};
}

} // namespace

std::vector<InputEvent> parse_browser_event(const std::string& text) {
    if (text.size() > kMostBytes) return {};
    try {
        return make_browser_event(read_json(text));
    } catch (const std::exception&) {
        return {};
    }
}

struct BrowserServer::Implementation {
    std::function<void()> on_events;
    std::string token = make_token();
    std::mutex mutex;
    std::condition_variable has_picture;
    std::vector<InputEvent> events;
    /// Releases of the buttons that pages hold.
    std::map<const mg_connection*, std::vector<InputEvent>> releases;
    std::shared_ptr<const std::vector<uint8_t>> jpeg;
    std::string text;
    uint64_t version = 0;
    bool is_ending = false;
    mg_context* context = nullptr;

    bool is_allowed(const mg_connection* connection) const {
        return are_equal(get_variable(*mg_get_request_info(connection), "token"), token);
    }

    int answer_page(mg_connection* connection) {
        if (!is_allowed(connection)) return mg_send_http_error(connection, 403, "%s", "wrong token"), 403;
        const size_t bytes = std::string_view(kBrowserPage).size();
        mg_printf(connection,
                  "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nContent-Length: %zu\r\nCache-Control: "
                  "no-store\r\nReferrer-Policy: no-referrer\r\n\r\n",
                  bytes);
        mg_write(connection, kBrowserPage, bytes);
        return 200;
    }

    /// Waits for a picture that is newer than the one that the browser has.
    int answer_picture(mg_connection* connection) {
        if (!is_allowed(connection)) return mg_send_http_error(connection, 403, "%s", "wrong token"), 403;
        const std::string after = get_variable(*mg_get_request_info(connection), "after");
        std::shared_ptr<const std::vector<uint8_t>> shown;
        std::string header;
        {
            std::unique_lock lock(mutex);
            has_picture.wait_for(lock, std::chrono::seconds(kPatience),
                                 [&] { return is_ending || (jpeg && std::to_string(version) != after); });
            if (jpeg && std::to_string(version) != after) shown = jpeg;
            header = fmt::format("X-Relief-Version: {}\r\nX-Relief-Text: {}\r\n", version, escape(text));
        }
        if (!shown) {
            mg_printf(connection, "HTTP/1.1 204 No Content\r\n\r\n");
            return 204;
        }
        mg_printf(connection,
                  "HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: %zu\r\nCache-Control: "
                  "no-store\r\n%s\r\n",
                  shown->size(), header.c_str());
        mg_write(connection, shown->data(), shown->size());
        return 200;
    }

    void note_buttons(const mg_connection* connection, const InputEvent& event) {
        using Kind = InputEvent::Kind;
        if (event.kind != Kind::press && event.kind != Kind::release) return;
        std::vector<InputEvent>& held = releases[connection];
        std::erase_if(held, [&](const InputEvent& release) { return release.button == event.button; });
        if (event.kind == Kind::release) return;
        held.push_back(event);
        held.back().kind = Kind::release;
    }

    void receive(const mg_connection* connection, const char* data, size_t size) {
        std::vector<InputEvent> made = parse_browser_event(std::string(data, size));
        if (made.empty()) return;
        {
            const std::lock_guard lock(mutex);
            for (const InputEvent& event : made) note_buttons(connection, event);
            std::move(made.begin(), made.end(), std::back_inserter(events));
        }
        on_events();
    }

    /// A page that goes away lets go of what it holds.
    void close(const mg_connection* connection) {
        {
            const std::lock_guard lock(mutex);
            const auto held = releases.extract(connection);
            if (held.empty()) return;
            std::move(held.mapped().begin(), held.mapped().end(), std::back_inserter(events));
        }
        on_events();
    }

    void add_handlers() {
        mg_set_request_handler(
            context, "/$",
            [](mg_connection* c, void* data) { return static_cast<Implementation*>(data)->answer_page(c); },
            this);
        mg_set_request_handler(
            context, "/picture$",
            [](mg_connection* c, void* data) {
                return static_cast<Implementation*>(data)->answer_picture(c);
            },
            this);
        mg_set_websocket_handler(
            context, "/events$",
            [](const mg_connection* c, void* data) {
                return static_cast<Implementation*>(data)->is_allowed(c) ? 0 : 1;
            },
            nullptr,
            [](mg_connection* c, int, char* bytes, size_t size, void* data) {
                static_cast<Implementation*>(data)->receive(c, bytes, size);
                return 1;
            },
            [](const mg_connection* c, void* data) { static_cast<Implementation*>(data)->close(c); }, this);
    }
};

BrowserServer::BrowserServer(int port, std::function<void()> on_events)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    self.on_events = std::move(on_events);
    const std::string address = fmt::format("127.0.0.1:{}", port);
    const char* options[] = {"listening_ports",    address.c_str(), "num_threads", "32",
                             "request_timeout_ms", "30000",         nullptr};
    mg_init_library(0);
    const mg_callbacks callbacks{};
    self.context = mg_start(&callbacks, this, options);
    if (!self.context) {
        mg_exit_library();
        throw Error(ErrorKind::failed, {fmt::format("{} cannot be listened on", address), "--serve",
                                        "another program has the port: name another one, or 0 for any"});
    }
    self.add_handlers();
}

BrowserServer::~BrowserServer() {
    {
        const std::lock_guard lock(implementation_->mutex);
        implementation_->is_ending = true;
    }
    implementation_->has_picture.notify_all();
    mg_stop(implementation_->context);
    mg_exit_library();
}

std::string BrowserServer::url() const {
    mg_server_port port{};
    mg_get_server_ports(implementation_->context, 1, &port);
    return fmt::format("http://127.0.0.1:{}/?token={}", port.port, implementation_->token);
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
    self.has_picture.notify_all();
}

} // namespace relief::viewer
