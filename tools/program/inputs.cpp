#include "tools/program/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "tracer/scene/scene.hpp"
#include "tracer/scene/scene_name.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

InputKind kind_of_name(const std::string& name) {
    if (name.ends_with(".glb") || name.ends_with(".gltf")) return InputKind::scene;
    return name.ends_with(".rct") ? InputKind::trace : InputKind::unknown;
}

void check_name(const std::string& name) {
    std::error_code ignored;
    if (kind_of_input(name) != InputKind::unknown || std::filesystem::exists(name, ignored)) return;
    std::vector<std::string> scenes;
    for (const auto& scene : tracer::builtin_scenes()) scenes.push_back(scene.name);
    throw UsageError(
        fmt::format("'{}': expected a scene (a .glb or .gltf file, or one of 'raycache list scenes') or a trace file, "
                    "found no file of this name{}",
                    name, did_you_mean(name, scenes)));
}

}  // namespace

InputKind kind_of_input(const std::string& name) {
    if (tracer::find_builtin_scene(name)) return InputKind::scene;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(name, ignored)) return kind_of_name(name);
    std::array<char, 8> start{};
    std::ifstream file(name, std::ios::binary);
    file.read(start.data(), start.size());
    const std::string_view bytes(start.data(), static_cast<std::size_t>(file.gcount()));
    if (bytes.starts_with("RCTRACE")) return InputKind::trace;
    if (bytes.starts_with("glTF")) return InputKind::scene;
    const std::size_t text = bytes.find_first_not_of(" \t\r\n");
    if (text != std::string_view::npos && bytes[text] == '{') return InputKind::scene;
    return kind_of_name(name);
}

void InputOptions::add(Command& command, const std::string& traces) {
    traces_ = traces;
    command
        .add_option("INPUTS", names_,
                    fmt::format("a scene (a .glb or .gltf file, or one of 'raycache list scenes'), or {}", traces))
        ->check([](std::string& name) { check_name(name); });
    command.add_option("--scene", scene_, "the scene, as INPUTS")
        ->check([](std::string& name) { tracer::check_scene_name(name); })
        ->type_name("SCENE");
}

Inputs InputOptions::sorted(const Command& command) const {
    Inputs inputs;
    std::vector<std::string> scenes;
    if (!scene_.empty()) scenes.push_back(scene_);
    for (const std::string& name : names_)
        (kind_of_input(name) == InputKind::scene ? scenes : inputs.traces).push_back(name);
    if (scenes.size() + inputs.traces.size() == 0)
        throw UsageError(
            fmt::format("INPUTS is missing: expected a scene (or --scene SCENE), or {}; see 'raycache {} "
                        "--help'",
                        traces_, command.name()));
    if (scenes.size() > 1)
        throw UsageError(
            fmt::format("'{}' and '{}' are both scenes; expected one (a scene is given as INPUTS or with "
                        "--scene)",
                        scenes[0], scenes[1]));
    if (!scenes.empty() && !inputs.traces.empty())
        throw UsageError(
            fmt::format("'{}' is a scene and '{}' a trace; expected either one scene (as INPUTS or with --scene), or "
                        "trace files",
                        scenes[0], inputs.traces[0]));
    if (!scenes.empty()) {
        inputs.scene = scenes[0];
        return inputs;
    }
    return inputs;
}

}  // namespace raycache::tools
