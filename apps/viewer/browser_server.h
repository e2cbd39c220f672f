// Pictures for browsers on this machine, and what is done there: HTTP on 127.0.0.1, a token in the address.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "viewer/input_event.h"

namespace relief::viewer {

class BrowserServer {
  public:
    /// `port` 0: any that is free. `on_events` is called by other threads when take_events() has something.
    /// Throws Error{failed} where the port cannot be had.
    BrowserServer(int port, std::function<void()> on_events);
    ~BrowserServer();
    BrowserServer(const BrowserServer&) = delete;
    BrowserServer& operator=(const BrowserServer&) = delete;

    /// With the token: who has it sees the picture and turns the camera.
    std::string url() const;
    std::vector<InputEvent> take_events();
    /// The picture that all browsers get now, as a JPEG, and what is said below it. Never waits for them.
    void show(std::vector<uint8_t> jpeg, std::string text);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// An event of a page: {"kind": "press", "x": 10, "y": 20, "button": 0, "shift": false, ...}. Nothing for
/// texts that mean none: they come from outside.
std::vector<InputEvent> parse_browser_event(const std::string& text);

/// The page that shows the pictures, for the path `/`.
extern const char* const kBrowserPage;

} // namespace relief::viewer
