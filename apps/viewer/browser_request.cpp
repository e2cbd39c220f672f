#include "viewer/browser_request.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "common/values.h"

namespace relief::viewer {

namespace {

std::string find_or_empty(const std::map<std::string, std::string>& values, const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? std::string() : found->second;
}

std::string_view trim(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = char(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

/// "GET /picture?token=X HTTP/1.1".
bool parse_first_line(std::string_view line, BrowserRequest& request) {
    const size_t first = line.find(' '), last = line.rfind(' ');
    if (first == std::string_view::npos || last <= first || !line.substr(last + 1).starts_with("HTTP/1."))
        return false;
    const std::string_view target = line.substr(first + 1, last - first - 1);
    const size_t question = std::min(target.find('?'), target.size());
    request.method = line.substr(0, first), request.path = target.substr(0, question);
    for (const std::string& pair :
         cli::split(std::string(target.substr(std::min(question + 1, target.size()))), '&')) {
        const size_t equals = std::min(pair.find('='), pair.size());
        request.variables.emplace(pair.substr(0, equals), pair.substr(std::min(equals + 1, pair.size())));
    }
    return request.path.starts_with('/');
}

/// Takes as long wherever the first difference is.
bool are_equal(const std::string& a, const std::string& b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) difference |= unsigned(a[k] ^ b[k]);
    return difference == 0;
}

/// Whether "NAME" or "NAME:PORT" means this machine. Any port is accepted, since a tunnel has one of its own.
bool is_this_machine(const std::string& host) {
    constexpr std::array<std::string_view, 3> kNames = {"127.0.0.1", "localhost", "[::1]"};
    return std::ranges::any_of(kNames, [&](std::string_view name) {
        if (!host.starts_with(name)) return false;
        const std::string_view rest = std::string_view(host).substr(name.size());
        return rest.empty() || (rest.size() > 1 && rest.front() == ':' &&
                                rest.find_first_not_of("0123456789", 1) == std::string_view::npos);
    });
}

} // namespace

std::string BrowserRequest::variable(const std::string& name) const { return find_or_empty(variables, name); }
std::string BrowserRequest::header(const std::string& name) const { return find_or_empty(headers, name); }

std::optional<BrowserRequest> parse_request(std::string_view lines) {
    BrowserRequest request;
    bool is_first = true;
    while (!lines.empty()) {
        const size_t end = lines.find("\r\n");
        const std::string_view line = lines.substr(0, end);
        lines = end == std::string_view::npos ? std::string_view() : lines.substr(end + 2);
        if (is_first && !parse_first_line(line, request)) return std::nullopt;
        if (!std::exchange(is_first, false) && !line.empty()) {
            const size_t colon = line.find(':');
            if (colon == std::string_view::npos) return std::nullopt;
            const auto [at, is_new] =
                request.headers.emplace(lower(line.substr(0, colon)), trim(line.substr(colon + 1)));
            if (!is_new && (at->first == "host" || at->first == "origin")) return std::nullopt;
        }
    }
    return is_first ? std::nullopt : std::optional(request);
}

std::optional<Refusal> refuse_request(const BrowserRequest& request, const std::string& token) {
    if (request.method != "GET" && request.method != "HEAD") return Refusal{405, "only GET and HEAD"};
    const std::string host = lower(request.header("host"));
    if (!is_this_machine(host))
        return Refusal{403, "the address must be one of this machine, such as localhost"};
    if (request.headers.contains("origin") && lower(request.header("origin")) != "http://" + host)
        return Refusal{403, "sent by a page of another place"};
    if (!are_equal(request.variable("token"), token)) return Refusal{403, "wrong token"};
    return std::nullopt;
}

std::string escape(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        result +=
            is_plain ? std::string(1, c) : fmt::format("%{:02X}", unsigned(static_cast<unsigned char>(c)));
    }
    return result;
}

} // namespace relief::viewer
