#include "io/scene/motion_json.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "io/scene/scene_values.h"
#include "relief/error.h"

namespace relief {

namespace {

[[noreturn]] void refuse(const std::string& message, const std::string& where) {
    throw Error(ErrorKind::usage, {message, where, "a list for each thing that moves, with a value a frame"});
}

template <class Lists, class Items>
void check_lists(const Lists& lists, const Items& items, size_t frame_count, const char* what) {
    for (const auto& [name, list] : lists) {
        const std::string where = fmt::format("{} '{}'", what, name);
        if (list.size() != frame_count)
            refuse(fmt::format("{} values for {} frames", list.size(), frame_count), where);
        if (std::ranges::count(items, name, [](const auto& item) { return item.name; }) != 1)
            refuse("is not in the scene, or more than once", where);
    }
}

} // namespace

void check_motion(const Scene& scene, const SceneMotion& motion) {
    check_lists(motion.objects, scene.objects, motion.frame_count, "object");
    check_lists(motion.maps, scene.displacements, motion.frame_count, "displacement");
    for (const auto& [name, maps] : motion.maps)
        if (std::ranges::find(maps, nullptr) != maps.end())
            refuse("a map is missing", fmt::format("displacement '{}'", name));
}

Json write_placements(const std::vector<SceneMotion::Placement>& placements, int first_frame) {
    using Placement = SceneMotion::Placement;
    Json transform = Json::object();
    for (const auto& [key, member] :
         {std::pair("translate", &Placement::translate),
          std::pair("rotate_degrees", &Placement::rotate_degrees), std::pair("scale", &Placement::scale)}) {
        const Vec3f& first = placements.front().*member;
        const auto is_first = [&, member = member](const Placement& p) { return p.*member == first; };
        if (std::ranges::all_of(placements, is_first)) {
            if (!(first == Placement{}.*member)) transform[key] = to_json(first);
            continue;
        }
        Json keys = Json::array();
        int frame = first_frame;
        for (const Placement& placement : placements)
            keys.push_back(Json::array({frame++, to_json(placement.*member)}));
        transform[key]["keys"] = std::move(keys);
    }
    return transform;
}

void write_views(const SceneMotion& motion, Json& camera) {
    Json from = Json::array(), to = Json::array();
    for (const SceneMotion::View& view : motion.views) {
        from.push_back(Json::array({view.frame, to_json(view.from)}));
        to.push_back(Json::array({view.frame, to_json(view.to)}));
    }
    camera["from"] = {{"keys", std::move(from)}, {"interpolation", "smooth"}};
    camera["to"] = {{"keys", std::move(to)}, {"interpolation", "smooth"}};
}

} // namespace relief
