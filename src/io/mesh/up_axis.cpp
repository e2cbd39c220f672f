#include "io/mesh/up_axis.h"

#include <array>

namespace relief {

Vec3f get_upright_turn(UpAxis up) {
    constexpr std::array<Vec3f, 3> kTurns = {Vec3f{0, 0, 90}, Vec3f{0, 0, 0}, Vec3f{-90, 0, 0}};
    return kTurns[size_t(up)];
}

void turn_upright(Mesh& mesh, UpAxis up) {
    const auto turn = [up](float& x, float& y, float& z) {
        const Vec3f v{x, y, z};
        if (up == UpAxis::x) x = 0 - v.y, y = v.x; // no -0
        if (up == UpAxis::z) y = v.z, z = 0 - v.y;
    };
    for (Vec3f& p : mesh.positions) turn(p.x, p.y, p.z);
    for (Vec3f& n : mesh.normals) turn(n.x, n.y, n.z);
    for (std::array<float, 4>& t : mesh.tangents) turn(t[0], t[1], t[2]);
}

} // namespace relief
