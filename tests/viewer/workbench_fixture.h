// A workbench with the bumpy plane's files, and a user.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "viewer/fixture.h"
#include "viewer/workbench.h"

namespace relief::viewer {

class WorkbenchTest : public FolderTest {
  protected:
    using Kind = InputEvent::Kind;

    void SetUp() override;
    void TearDown() override;
    /// Lets time go on until something is true, at most for a minute.
    bool reach(const std::function<bool()>& is_true);
    bool reach_done();
    void open_scene();
    void send(Kind kind, float x, float y, MouseButton button = MouseButton::left, Modifiers modifiers = {});
    void press_key(int key, Modifiers modifiers = {});
    void drag(float x0, float y0, float x1, float y1, MouseButton button = MouseButton::left);
    /// What the command makes of a saved scene.
    std::vector<float> render_file(const std::string& name);

    RenderSettings settings_;
    PictureDefaults given_;
    std::unique_ptr<Workbench> bench_;
};

} // namespace relief::viewer
