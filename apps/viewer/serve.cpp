#include "viewer/serve.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <fmt/format.h>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

#include "common/console.h"
#include "common/exit_codes.h"
#include "viewer/browser_server.h"
#include "viewer/signals.h"
#include "viewer/workbench.h"

namespace relief::viewer {

namespace {

/// Quality of JPEG, of 100: of pictures that move and of others.
constexpr int kMovingQuality = 75, kStillQuality = 92;
/// Seconds of waiting where nothing happens, and where something moves.
constexpr double kServeIdle = 0.1, kServeMoving = 0.01;

/// Lets the loop sleep until another thread has something for it.
class Bell {
  public:
    void ring() {
        {
            const std::lock_guard lock(mutex_);
            has_rung_ = true;
        }
        rings_.notify_all();
    }
    void wait(double seconds) {
        std::unique_lock lock(mutex_);
        rings_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return has_rung_; });
        has_rung_ = false;
    }

  private:
    std::mutex mutex_;
    std::condition_variable rings_;
    bool has_rung_ = false;
};

std::vector<uint8_t> encode_jpeg(const Image& image, const DisplayTable& display, int quality) {
    const std::vector<uint8_t> bytes = make_view(image, {}, display);
    std::vector<uint8_t> jpeg;
    stbi_write_jpg_to_func(
        [](void* to, void* data, int size) {
            auto& out = *static_cast<std::vector<uint8_t>*>(to);
            const auto* const from = static_cast<const uint8_t*>(data);
            out.insert(out.end(), from, from + size);
        },
        &jpeg, image.width, image.height, 4, bytes.data(), quality);
    return jpeg;
}

std::string describe_state(const Workbench& workbench, const ShownPicture& picture) {
    if (!workbench.explanation().text.empty()) return workbench.explanation().text;
    if (picture.motion != Motion::still)
        return fmt::format("{} x {}", picture.image.width, picture.image.height);
    const int total = workbench.settings().image.spp;
    return fmt::format("{} of {} samples  {}", picture.is_complete ? total : picture.samples, total,
                       workbench.message());
}

/// Places of a page are shares of the picture.
InputEvent place_event(InputEvent event, const ImageSettings& image) {
    event.x *= float(image.width), event.y *= float(image.height);
    return event;
}

DisplayTable make_display() {
    try {
        return DisplayTable(kDisplayNames[0]);
    } catch (const std::exception&) { // its libraries are missing
        return {};
    }
}

} // namespace

int serve(const ViewerOptions& options) {
    Bell bell;
    note_signals();
    Workbench workbench(options.settings, options.given, [&] { bell.ring(); });
    const ImageSettings& image = workbench.settings().image;
    workbench.set_area({0, 0, float(image.width), float(image.height)});
    BrowserServer server(options.port.value(), [&] { bell.ring(); });
    print_output("{}\n", server.url()), flush_output();
    workbench.open(options.input);
    const DisplayTable display = make_display();
    std::shared_ptr<const ShownPicture> shown;
    std::string text;
    const auto start = std::chrono::steady_clock::now();
    while (get_signal() == 0) {
        for (const InputEvent& event : server.take_events()) workbench.handle(place_event(event, image));
        workbench.update(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        workbench.refuse_nothing_open();
        if (const std::shared_ptr<const ShownPicture> picture = workbench.picture()) {
            const std::string state = describe_state(workbench, *picture);
            if (picture != shown || state != text)
                server.show(encode_jpeg(picture->image, display,
                                        picture->motion == Motion::still ? kStillQuality : kMovingQuality),
                            state);
            shown = picture, text = state;
        }
        bell.wait(workbench.is_moving() ? kServeMoving : kServeIdle);
    }
    return cli::kExitSignalBase + get_signal();
}

} // namespace relief::viewer
