// HTTP requests of browsers, as text, and which of them are refused before anything is done for them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace relief::viewer {

inline constexpr size_t kMostRequestBytes = 8192; ///< of the lines of a request; a longer one is refused

struct BrowserRequest {
    std::string method, path;
    std::map<std::string, std::string> variables; ///< of the query: token=..., values as they are written
    std::map<std::string, std::string> headers;   ///< names in lower case

    /// Empty where there is none.
    std::string variable(const std::string& name) const;
    std::string header(const std::string& name) const;
};

/// The lines of a request up to the empty one. nullopt: this is no HTTP, or a header that counts here is
/// given twice.
std::optional<BrowserRequest> parse_request(std::string_view lines);

struct Refusal {
    int status = 0;
    std::string reason;
};

/// nullopt for a request that may be answered: GET or HEAD, with the token, to a name of this machine, and
/// not sent by a page of another place. The name keeps out pages whose own name was made to lead here.
std::optional<Refusal> refuse_request(const BrowserRequest& request, const std::string& token);

/// For a header: letters and digits as they are, other bytes as %XX.
std::string escape(const std::string& text);

} // namespace relief::viewer
