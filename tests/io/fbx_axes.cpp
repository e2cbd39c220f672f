// Axes and unit that FBX files say they have.
#include "io/test_files.h"
#include "math/box.h"
#include "relief/io.h"
#include "support/fbx_text.h"

namespace relief {

namespace {

struct Axes {
    int up, up_sign, front, front_sign, right, right_sign;
};

/// The grid, whose points are (x, y, x y) in the axes of the file.
std::string make_fbx(const Axes& axes, double unit) {
    std::string text = make_grid_fbx(1),
                settings = "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n";
    const auto add = [&](const char* name, const char* type, const std::string& value) {
        settings += std::string("\t\tP: \"") + name + "\", " + type + ", \"\"," + value + "\n";
    };
    const auto add_axis = [&](const std::string& name, int axis, int sign) {
        add(name.c_str(), R"("int", "Integer")", std::to_string(axis));
        add((name + "Sign").c_str(), R"("int", "Integer")", std::to_string(sign));
    };
    add_axis("UpAxis", axes.up, axes.up_sign), add_axis("FrontAxis", axes.front, axes.front_sign);
    add_axis("CoordAxis", axes.right, axes.right_sign);
    add("UnitScaleFactor", R"("double", "Number")", std::to_string(unit));
    return text.insert(text.find("Objects:"), settings + "\t}\n}\n");
}

} // namespace

class FbxAxes : public FileTest {
  protected:
    Box load(const Axes& axes, double unit = 1) {
        warnings_.clear();
        Box box;
        for (const Vec3f& p : load_mesh(write("a.fbx", make_fbx(axes, unit)), {}, warnings_).positions)
            box.extend(p);
        return box;
    }
    std::vector<std::string> warnings_;
};

TEST_F(FbxAxes, are_turned_to_y_up) {
    const Box y_up = load({1, 1, 2, 1, 0, 1});
    EXPECT_EQ(y_up.lower, (Vec3f{0, 0, 0}));
    EXPECT_EQ(y_up.upper, (Vec3f{1, 1, 1}));
    const Box z_up = load({2, 1, 1, -1, 0, 1}, 100);
    EXPECT_EQ(z_up.lower, (Vec3f{0, 0, -1})) << "y of the file points away from the viewer";
    EXPECT_EQ(z_up.upper, (Vec3f{1, 1, 0}));
    const Box x_up = load({0, -1, 2, 1, 1, 1});
    EXPECT_EQ(x_up.lower, (Vec3f{0, -1, 0}));
    EXPECT_EQ(x_up.upper, (Vec3f{1, 0, 1}));
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(FbxAxes, that_mirror_keep_the_outside_outside) {
    const auto find_area = [&](const Axes& axes) {
        const Mesh mesh = load_mesh(write("a.fbx", make_fbx(axes, 1)));
        const auto at = [&](size_t k) { return mesh.positions[mesh.position_indices[k]]; };
        return cross(at(1) - at(0), at(2) - at(0));
    };
    EXPECT_GT(find_area({1, 1, 2, 1, 0, 1}).z, 0);
    EXPECT_LT(find_area({1, 1, 2, -1, 0, 1}).z, 0) << "z is mirrored, and with it the normal";
}

TEST_F(FbxAxes, that_are_not_three_and_other_units_are_warned_of) {
    EXPECT_EQ(load({1, 1, 1, 1, 0, 1}).upper, (Vec3f{1, 1, 1}));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "a.fbx: its axes (right 0, up 1, front 1");
    EXPECT_HAS(warnings_[0], "Relief takes y for up and z for front; export it with Y up");
    EXPECT_EQ(load({1, 1, 2, 1, 0, 1}, 2.54).upper, (Vec3f{1, 1, 1}));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "its unit of length is 2.54 cm");
    EXPECT_HAS(warnings_[0], "scale the object by 0.0254");
}

} // namespace relief
