#include "viewer/workbench_fixture.h"

#include <chrono>

#include "relief/io.h"

namespace relief::viewer {

namespace {

double read_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

void WorkbenchTest::SetUp() {
    FolderTest::SetUp();
    write_scene_files();
    settings_ = make_small_settings();
    given_.spp = settings_.image.spp;
    bench_ = std::make_unique<Workbench>(settings_, given_);
    bench_->set_area({0, 0, 48, 32});
}

void WorkbenchTest::TearDown() {
    bench_.reset();
    FolderTest::TearDown();
}

bool WorkbenchTest::reach(const std::function<bool()>& is_true) {
    return wait_until([&] {
        bench_->update(read_now());
        return is_true();
    });
}

bool WorkbenchTest::reach_done() {
    return reach([&] { return bench_->is_done(); });
}

void WorkbenchTest::open_scene() {
    bench_->open({folder_ / "scene.json", {}, {}});
    ASSERT_TRUE(reach_done()) << bench_->message();
}

void WorkbenchTest::send(Kind kind, float x, float y, MouseButton button, Modifiers modifiers) {
    InputEvent event;
    event.kind = kind, event.x = x, event.y = y, event.button = button, event.modifiers = modifiers;
    bench_->handle(event);
}

void WorkbenchTest::press_key(int key, Modifiers modifiers) {
    InputEvent event;
    event.kind = Kind::key_down, event.key = key, event.modifiers = modifiers;
    bench_->handle(event);
    event.kind = Kind::key_up;
    bench_->handle(event);
}

void WorkbenchTest::drag(float x0, float y0, float x1, float y1, MouseButton button) {
    send(Kind::press, x0, y0, button);
    for (int k = 1; k <= 8; ++k)
        send(Kind::move, x0 + (x1 - x0) * float(k) / 8, y0 + (y1 - y0) * float(k) / 8, button);
    send(Kind::release, x1, y1, button);
}

std::vector<float> WorkbenchTest::render_file(const std::string& name) {
    const Scene scene = load_scene(folder_ / name);
    RenderSettings settings = settings_;
    settings.image.width = scene.picture.width.value();
    settings.image.height = scene.picture.height.value();
    settings.image.spp = scene.picture.spp.value();
    return render(scene, settings).image.pixels;
}

} // namespace relief::viewer
