// The one owner of a prepared scene with write access.
#include "prepare/scene_edit.h"

#include <algorithm>
#include <type_traits>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "support/bodies.h"

namespace relief {
namespace {

static_assert(
    std::is_same_v<decltype(std::declval<SceneEditor>().scene()), std::shared_ptr<const PreparedScene>>);
static_assert(
    std::is_same_v<decltype(prepare_scene(std::declval<Scene>(), {})), std::shared_ptr<const PreparedScene>>);

class SceneEdit : public testing::Test {
  protected:
    SceneEdit() {
        scene_ = test::make_body_scene(test::make_cube_sphere(4),
                                       test::make_displacement(map_, DisplacementSpace::tangent));
        scene_.hash = 17;
        scene_.displacements[0].name = "bumps", scene_.displacements[0].dilate = false;
        edit_.displacement = "bumps";
        edit_.x = 3, edit_.y = 5;
        edit_.texels.width = edit_.texels.height = 2;
        edit_.texels.floats.assign(16, 0.25f);
        settings_.surface.level = 2;
    }

    std::shared_ptr<Texture> map_ = test::make_random_map(64, 48, 0.1f, 3);
    Scene scene_;
    MapEdit edit_;
    RenderSettings settings_;
};

TEST_F(SceneEdit, changes_the_view_that_others_hold_and_not_the_callers_map) {
    SceneEditor editor(scene_, settings_);
    const std::shared_ptr<const PreparedScene> view = editor.scene();
    const size_t texel = 4 * (5 * 64 + 3);
    const float before = map_->floats[texel];
    const std::vector<SurfaceChange> changes = editor.apply(editor.check(edit_));
    EXPECT_EQ(view->maps[0].texture->floats[texel], 0.25f);
    EXPECT_EQ(map_->floats[texel], before);
    ASSERT_EQ(changes.size(), 1u);
    const auto count = [](const std::vector<uint8_t>& all) { return std::count(all.begin(), all.end(), 1); };
    EXPECT_GT(count(changes[0].is_changed), 0);
    EXPECT_LT(count(changes[0].is_changed), 96);
    EXPECT_GE(count(changes[0].looks_different), count(changes[0].is_changed));
}

TEST_F(SceneEdit, names_the_scene_anew_only_when_it_is_applied) {
    SceneEditor editor(scene_, settings_);
    EXPECT_EQ(editor.scene_hash(), 17u);
    const CheckedEdit checked = editor.check(edit_);
    EXPECT_EQ(editor.scene_hash(), 17u);
    editor.apply(checked);
    EXPECT_NE(editor.scene_hash(), 17u);
}

TEST_F(SceneEdit, is_refused_before_anything_changes) {
    const SceneEditor editor(scene_, settings_);
    edit_.x = 63;
    EXPECT_THROW(editor.check(edit_), Error);
    edit_.x = 3, edit_.displacement = "dents";
    EXPECT_THROW(editor.check(edit_), Error);
    settings_.surface.mode = SurfaceMode::tessellated;
    EXPECT_THROW(SceneEditor(scene_, settings_), Error);
}

} // namespace
} // namespace relief
