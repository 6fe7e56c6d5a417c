#include "tracer/scene/builtin/courtyard/courtyard.hpp"
#include "tracer/scene/builtin/room/room.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

const std::vector<BuiltinScene>& builtin_scenes() {
    static const std::vector<BuiltinScene> scenes{
        {"courtyard", "an arcaded yard with tables, railings, a fountain and trees of single leaves",
         courtyard::default_detail, courtyard::min_detail, courtyard::max_detail, courtyard::build},
        {"room", "a furnished living room by day: two windows, three lamps, wood, wool, glass and metal",
         room::default_detail, room::min_detail, room::max_detail, room::build},
    };
    return scenes;
}

const BuiltinScene* find_builtin_scene(const std::string& name) {
    for (const BuiltinScene& builtin : builtin_scenes())
        if (builtin.name == name) return &builtin;
    return nullptr;
}

}  // namespace raycache::tracer
