#include "tracer/scene/builtin/courtyard/courtyard.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

const std::vector<BuiltinScene>& builtin_scenes() {
    static const std::vector<BuiltinScene> scenes{
        {"courtyard", "an arcaded yard with tables, railings, a fountain and trees of single leaves",
         courtyard::default_detail, courtyard::min_detail, courtyard::max_detail, courtyard::build},
    };
    return scenes;
}

const BuiltinScene* find_builtin_scene(const std::string& name) {
    for (const BuiltinScene& builtin : builtin_scenes())
        if (builtin.name == name) return &builtin;
    return nullptr;
}

}  // namespace raycache::tracer
