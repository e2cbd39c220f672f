#include "viewer/window.h"

#include <cmath>
#include <cstring>
#include <mutex>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include "relief/error.h"
#include "relief/image.h"
#include "relief/io.h"

namespace relief::viewer {

namespace {

/// Linear value of a byte in sRGB (IEC 61966-2-1).
float decode_byte(uint8_t byte) {
    const float x = float(byte) / 255;
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

/// What GLFW said last: it tells errors by a call, not by exceptions.
std::string& get_last_error() {
    static std::string text;
    return text;
}

[[noreturn]] void refuse_display() {
    throw Error(ErrorKind::device_missing,
                {fmt::format("no window can be opened: {}", get_last_error()), "",
                 "a display with OpenGL 3.3 is needed; without one `relief view SCENE --serve 0` shows "
                 "the scene in a browser, through a tunnel too, and `relief render` makes pictures"});
}

/// Whether there is a window that can be woken: threads that load and render begin before it and end after
/// it.
struct WakeGate {
    std::mutex mutex;
    bool is_open = false;
};

WakeGate& get_wake_gate() {
    static WakeGate gate;
    return gate;
}

void set_wake_gate(bool is_open) {
    WakeGate& gate = get_wake_gate();
    const std::lock_guard lock(gate.mutex);
    gate.is_open = is_open;
}

Modifiers make_modifiers(int bits) {
    return {(bits & GLFW_MOD_SHIFT) != 0, (bits & GLFW_MOD_CONTROL) != 0, (bits & GLFW_MOD_ALT) != 0};
}

/// The bit of a key that is a modifier; 0: it is none.
int find_modifier(int key) {
    switch (key) {
    case GLFW_KEY_LEFT_SHIFT:
    case GLFW_KEY_RIGHT_SHIFT:
        return GLFW_MOD_SHIFT;
    case GLFW_KEY_LEFT_CONTROL:
    case GLFW_KEY_RIGHT_CONTROL:
        return GLFW_MOD_CONTROL;
    case GLFW_KEY_LEFT_ALT:
    case GLFW_KEY_RIGHT_ALT:
        return GLFW_MOD_ALT;
    default:
        return 0;
    }
}

/// 0: a key that says nothing.
int make_key(int key, int scancode) {
    constexpr std::pair<int, int> kKeys[] = {
        {GLFW_KEY_ESCAPE, kEscape}, {GLFW_KEY_ENTER, kEnter}, {GLFW_KEY_F1, kF1},
        {GLFW_KEY_F12, kF12},       {GLFW_KEY_LEFT, kLeft},   {GLFW_KEY_RIGHT, kRight},
        {GLFW_KEY_UP, kUp},         {GLFW_KEY_DOWN, kDown},   {GLFW_KEY_HOME, kHome},
        {GLFW_KEY_SPACE, ' '},      {GLFW_KEY_KP_ADD, '+'},   {GLFW_KEY_KP_SUBTRACT, '-'},
        {GLFW_KEY_KP_DECIMAL, '.'}};
    if (find_modifier(key) != 0) return kModifier;
    for (const auto& [from, to] : kKeys)
        if (key == from) return to;
    const char* const name = glfwGetKeyName(key, scancode); // of the user's own keyboard
    if (!name || std::strlen(name) != 1) return 0;
    return name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + 'A' : name[0];
}

} // namespace

/// What GLFW calls: ImGui and the window both hear of it.
struct Window::Callbacks {
    static Window& get(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

    static InputEvent make_event(GLFWwindow* window, InputEvent::Kind kind, int modifiers) {
        InputEvent event;
        event.kind = kind;
        double x = 0, y = 0;
        glfwGetCursorPos(window, &x, &y);
        event.x = float(x), event.y = float(y);
        event.modifiers = make_modifiers(modifiers);
        return event;
    }
    static void button(GLFWwindow* window, int button, int action, int modifiers) {
        ImGui_ImplGlfw_MouseButtonCallback(window, button, action, modifiers);
        if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
        using Kind = InputEvent::Kind;
        InputEvent event = make_event(window, action == GLFW_PRESS ? Kind::press : Kind::release, modifiers);
        event.button = button == GLFW_MOUSE_BUTTON_LEFT    ? MouseButton::left
                       : button == GLFW_MOUSE_BUTTON_RIGHT ? MouseButton::right
                                                           : MouseButton::middle;
        get(window).receive(event);
    }
    static void cursor(GLFWwindow* window, double, double) {
        get(window).receive(make_event(window, InputEvent::Kind::move, 0));
    }
    static void scroll(GLFWwindow* window, double across, double along) {
        ImGui_ImplGlfw_ScrollCallback(window, across, along);
        InputEvent event = make_event(window, InputEvent::Kind::scroll, 0);
        event.amount = float(along);
        get(window).receive(event);
    }
    static void key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
        ImGui_ImplGlfw_KeyCallback(window, key, scancode, action, modifiers);
        using Kind = InputEvent::Kind;
        const int own = find_modifier(key); // X11 tells the modifiers before the event
        InputEvent event = action == GLFW_RELEASE ? make_event(window, Kind::key_up, modifiers & ~own)
                                                  : make_event(window, Kind::key_down, modifiers | own);
        event.is_repeat = action == GLFW_REPEAT;
        event.key = make_key(key, scancode);
        if (event.key != 0) get(window).receive(event);
    }
    static void drop(GLFWwindow* window, int count, const char** names) {
        InputEvent event = make_event(window, InputEvent::Kind::drop, 0);
        for (int k = 0; k < count; ++k) event.files.emplace_back(names[k]);
        get(window).receive(event);
    }
};

Window::Window(int width, int height, const std::string& title) {
    glfwSetErrorCallback([](int, const char* text) { get_last_error() = text; });
    if (!glfwInit()) refuse_display();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) {
        glfwTerminate();
        refuse_display();
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    io.FontGlobalScale = content_scale();
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(content_scale());
    ImGui_ImplGlfw_InitForOpenGL(window_, false);
    glfwSetMouseButtonCallback(window_, Callbacks::button);
    glfwSetCursorPosCallback(window_, Callbacks::cursor);
    glfwSetScrollCallback(window_, Callbacks::scroll);
    glfwSetKeyCallback(window_, Callbacks::key);
    glfwSetCharCallback(window_, ImGui_ImplGlfw_CharCallback);
    glfwSetWindowFocusCallback(window_, ImGui_ImplGlfw_WindowFocusCallback);
    glfwSetDropCallback(window_, Callbacks::drop);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    glGenTextures(1, &texture_);
    set_wake_gate(true);
}

Window::~Window() {
    set_wake_gate(false);
    glDeleteTextures(1, &texture_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::is_for_panels(const InputEvent& event) const {
    const ImGuiIO& io = ImGui::GetIO();
    using Kind = InputEvent::Kind;
    switch (event.kind) {
    case Kind::press:
    case Kind::scroll:
        return io.WantCaptureMouse && !is_dragging_;
    case Kind::key_down: {
        const bool is_of_panels = event.key == kLeft || event.key == kRight || event.key == kUp ||
                                  event.key == kDown || event.key == kEnter || event.key == ' ';
        const bool ends = event.modifiers.control && event.key == 'Q';
        return !ends && (io.WantTextInput || (is_of_panels && io.NavVisible));
    }
    case Kind::move:
    case Kind::release:
    case Kind::key_up:
    case Kind::drop:
        break;
    }
    return false;
}

void Window::receive(InputEvent event) {
    if (is_for_panels(event)) return;
    if (event.kind == InputEvent::Kind::press) is_dragging_ = true;
    if (event.kind == InputEvent::Kind::release) is_dragging_ = false;
    events_.push_back(std::move(event));
}

std::vector<InputEvent> Window::take_events() { return std::exchange(events_, {}); }

void Window::wait_events(double seconds) {
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

void Window::wake() {
    WakeGate& gate = get_wake_gate();
    const std::lock_guard lock(gate.mutex);
    if (gate.is_open) glfwPostEmptyEvent();
}

void Window::refuse_close() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

bool Window::should_close() const { return glfwWindowShouldClose(window_) != 0; }

void Window::inject(const InputEvent& event) {
    using Kind = InputEvent::Kind;
    if (event.kind == Kind::press || event.kind == Kind::release)
        scripted_buttons_[event.button == MouseButton::left    ? 0
                          : event.button == MouseButton::right ? 1
                                                               : 2] = event.kind == Kind::press;
    if (event.kind != Kind::key_down && event.kind != Kind::key_up && event.kind != Kind::drop)
        scripted_mouse_ = event;
    receive(event);
}

void Window::begin_frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    if (scripted_mouse_) {
        io.MousePos = {scripted_mouse_->x, scripted_mouse_->y};
        for (int k = 0; k < 3; ++k) io.MouseDown[k] = scripted_buttons_[k];
    }
    if (is_dragging_) // a button that was pressed on the picture is none of the panels
        for (bool& is_down : io.MouseDown) is_down = false;
    ImGui::NewFrame();
}

void Window::end_frame() {
    ImGui::Render();
    int pixels_x = 0, pixels_y = 0;
    glfwGetFramebufferSize(window_, &pixels_x, &pixels_y);
    glViewport(0, 0, pixels_x, pixels_y);
    glClearColor(0.09f, 0.09f, 0.1f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    if (!screenshot_.empty()) save_screenshot();
    glfwSwapBuffers(window_);
}

void Window::save_screenshot() {
    const std::filesystem::path file = std::exchange(screenshot_, {});
    Image image;
    glfwGetFramebufferSize(window_, &image.width, &image.height);
    image.full_width = image.width, image.full_height = image.height;
    image.channels = {"R", "G", "B"};
    image.metadata["relief:display"] = "standard"; // the bytes are sRGB, and stay what they are
    const size_t row = 3 * size_t(image.width);
    std::vector<uint8_t> bytes(row * size_t(image.height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    for (size_t y = size_t(image.height); y-- > 0;) // OpenGL begins at the bottom
        for (size_t k = 0; k < row; ++k) image.pixels.push_back(decode_byte(bytes[y * row + k]));
    write_image(image, file);
}

int Window::width() const {
    int x = 0, y = 0;
    glfwGetWindowSize(window_, &x, &y);
    return x;
}

int Window::height() const {
    int x = 0, y = 0;
    glfwGetWindowSize(window_, &x, &y);
    return y;
}

float Window::pixel_ratio() const {
    int pixels = 0, y = 0;
    glfwGetFramebufferSize(window_, &pixels, &y);
    return width() > 0 ? float(pixels) / float(width()) : 1;
}

float Window::content_scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    // Where a unit of the mouse is several pixels, letters are that large already.
    return x / pixel_ratio();
}

void Window::upload(const std::vector<uint8_t>& bytes, int columns, int rows) {
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, columns, rows, 0, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, 0x812F); // clamp to edge: later than this header
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, 0x812F);
}

void* Window::texture() const { return reinterpret_cast<void*>(uintptr_t(texture_)); }

} // namespace relief::viewer
