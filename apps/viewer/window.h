// The window: GLFW, OpenGL 3.3 and Dear ImGui. Pictures are shown by a texture; nothing else is drawn by
// OpenGL.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/input_event.h"

struct GLFWwindow;

namespace relief::viewer {

class Window {
  public:
    /// Throws Error{device_missing} where there is no display, or none with OpenGL 3.3.
    Window(int width, int height, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Waits for events, at most so many seconds.
    void wait_events(double seconds);
    /// Ends the waiting; by any thread. Without a window nothing.
    static void wake();
    bool should_close() const;
    void refuse_close();

    /// An event of a script, which holds the mouse from the first one on.
    void inject(const InputEvent& event);
    /// Events since the last call that panels do not want.
    std::vector<InputEvent> take_events();

    /// A button is held that was pressed on the picture.
    bool is_dragging() const { return is_dragging_; }

    /// Between these two, ImGui takes widgets.
    void begin_frame();
    void end_frame();
    /// Keeps what end_frame() draws next as a PNG.
    void take_screenshot(const std::filesystem::path& file) { screenshot_ = file; }
    bool has_screenshot_to_take() const { return !screenshot_.empty(); }

    int width() const; ///< in units of the mouse
    int height() const;
    float pixel_ratio() const;   ///< pixels a unit of the mouse
    float content_scale() const; ///< of letters and lines

    /// The picture: bytes of red, green, blue and alpha; and what ImGui calls it.
    void upload(const std::vector<uint8_t>& bytes, int width, int height);
    void* texture() const;

  private:
    struct Callbacks;
    void receive(InputEvent event);
    bool is_for_panels(const InputEvent& event) const;
    void save_screenshot();

    GLFWwindow* window_ = nullptr;
    unsigned texture_ = 0;
    std::vector<InputEvent> events_;
    std::optional<InputEvent> scripted_mouse_; ///< place of a script's mouse; nothing: the real one counts
    bool scripted_buttons_[3] = {};
    bool is_dragging_ = false; ///< from the picture: panels get nothing until the button is released
    std::filesystem::path screenshot_;
};

} // namespace relief::viewer
