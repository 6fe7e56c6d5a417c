// load_scene(): a file or a built-in scene, lit and seen as asked.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "tracer/scene/emission.hpp"
#include "tracer/scene/gltf_cameras.hpp"
#include "tracer/scene/gltf_report.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/scene_name.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::tracer {

namespace {

// A clear day, for scenes without a light of their own. Constants chosen here, not measured; only the ratio of sun to
// sky shapes a picture, and none of it changes which rays are traced before the first bounce.
constexpr Vec3 day_sky{0.6F, 0.75F, 1.0F};             // radiance
constexpr Vec3 day_sun_direction{0.35F, 0.9F, 0.25F};  // to be normalised
constexpr Vec3 day_sun_irradiance{6.0F, 5.6F, 5.0F};

std::string builtin_names() {
    std::string names;
    for (const BuiltinScene& builtin : builtin_scenes()) names += (names.empty() ? "" : ", ") + builtin.name;
    return names.empty() ? "none" : names;
}

Scene build(const BuiltinScene& builtin, std::uint64_t detail) {
    if (detail == 0) detail = builtin.default_detail;
    if (detail < builtin.min_detail || detail > builtin.max_detail)
        throw UsageError(fmt::format("scene {}: expected a detail from {} to {} triangles, found {}; choose one within",
                                     builtin.name, builtin.min_detail, builtin.max_detail, detail));
    constexpr std::uint64_t triangle_bytes = 200;  // with its share of vertices, while it is built
    auto memory = std::make_shared<MemoryBudget>();
    memory->charge(detail * triangle_bytes, "scene " + builtin.name, fmt::format("its {} triangles", detail));
    Scene scene = builtin.build(detail);
    scene.memory = std::move(memory);
    return scene;
}

Scene load_file(const SceneRequest& request, const Warn& warn) {
    check_scene_name(request.source);
    if (request.detail != 0)
        throw UsageError(
            printable_line(fmt::format("scene {}: a detail of {} is given, but only built-in scenes ({}) have "
                                       "one; leave it out",
                                       request.source, request.detail, builtin_names())));
    return load_gltf(request.source, warn);
}

void light_file(Scene& scene, const SceneRequest& request, const Warn& warn) {
    const auto sky = request.sky;
    if (sky == SceneRequest::Sky::off) return;
    const bool emitter = emits_light(scene);
    if (sky == SceneRequest::Sky::automatic && emitter) return;
    scene.sky = day_sky;
    if (emitter) return;
    scene.sun = Sun{normalize(day_sun_direction), day_sun_irradiance};
    if (sky == SceneRequest::Sky::automatic && warn)
        warn(printable_line(fmt::format("{}: the file has no light; a sky and a sun are added", request.source)));
}

std::size_t find_camera(const Scene& scene, const std::string& wanted) {
    if (wanted.empty()) return 0;
    const auto named = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [&](const Camera& camera) { return camera.name == wanted; });
    if (named != scene.cameras.end()) return static_cast<std::size_t>(named - scene.cameras.begin());
    std::size_t index = 0;
    const char* end = wanted.data() + wanted.size();
    const auto parsed = std::from_chars(wanted.data(), end, index);
    if (parsed.ec == std::errc() && parsed.ptr == end && index < scene.cameras.size()) return index;
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) names.push_back(camera.name);
    throw UsageError(printable_line(fmt::format(
        "camera \"{}\": expected a name or index of a camera of {} ({}, or 0 to {}), "
        "found no such one{}",
        wanted, scene.name, fmt::join(names, ", "), scene.cameras.size() - 1, did_you_mean(wanted, names))));
}

std::string numbers_of(Vec3d v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

void aim(Camera& camera, Vec3d eye, Vec3d look_at, const SceneFrame& frame) {
    if (!std::isfinite(dot(eye, {1, 1, 1})) || !std::isfinite(dot(look_at, {1, 1, 1})))
        throw UsageError(
            fmt::format("camera: expected an eye and a look-at point of finite numbers, found {} and {}; "
                        "give three numbers for each",
                        numbers_of(eye), numbers_of(look_at)));
    for (const auto& [point, option] : {std::pair{eye, "--eye"}, std::pair{look_at, "--look-at"}})
        if (!is_usable_position(point.rounded()))
            throw UsageError(
                fmt::format("{} {}: expected a point within {:g} m of the origin on each axis, found one "
                            "beyond; move it closer",
                            option, numbers_of(point), max_coordinate));
    const Vec3d way = look_at - eye;
    const double distance = std::hypot(way.x, way.y, way.z);
    if (!(distance > 0))
        throw UsageError(fmt::format("camera: expected a look-at point apart from the eye, found both at {}; move one",
                                     numbers_of(eye)));
    camera.name = "eye";
    camera.problem = problem_of_eye(eye, frame);
    camera.eye = frame.to_local(eye).rounded();
    camera.forward = (way * (1 / distance)).rounded();
    camera.up = orthogonal_up(camera.forward, {0, 1, 0});
}

void choose_camera(Scene& scene, const SceneRequest& request) {
    const auto chosen = static_cast<std::ptrdiff_t>(find_camera(scene, request.camera));
    std::rotate(scene.cameras.begin(), scene.cameras.begin() + chosen, scene.cameras.begin() + chosen + 1);
    if (request.eye.has_value() != request.look_at.has_value())
        throw UsageError(fmt::format("camera: expected both an eye and a look-at point, found only {}; give both",
                                     request.eye ? "an eye" : "a look-at point"));
    if (request.eye) {
        Camera camera = scene.cameras.front();
        aim(camera, *request.eye, *request.look_at, scene.frame);
        scene.cameras.insert(scene.cameras.begin(), camera);
    }
    if (request.vertical_fov) {
        const float fov = *request.vertical_fov;
        if (!(fov > 0) || !(fov < 180))
            throw UsageError(
                fmt::format("camera: expected a vertical field of view above 0 and below 180 degrees, "
                            "found {}; choose one within",
                            fov));
        scene.cameras.front().vertical_fov = fov;
    }
    const Camera& camera = scene.cameras.front();
    if (!camera.problem.empty())
        throw Error(printable_line(
            fmt::format("{}: camera {}: {}; move it, or choose another place with --camera or with --eye and --look-at",
                        request.source, camera.name, camera.problem)));
}

}  // namespace

void check_scene_name(const std::string& source) {
    std::error_code error;
    if (find_builtin_scene(source) || std::filesystem::exists(source, error)) return;
    std::vector<std::string> names;
    for (const BuiltinScene& builtin : builtin_scenes()) names.push_back(builtin.name);
    const std::string meant = did_you_mean(source, names);
    throw UsageError(printable_line(
        fmt::format("scene \"{}\": expected a .glb or .gltf file or a built-in scene ({}), found neither: "
                    "the file does not exist{}",
                    source, builtin_names(), meant.empty() ? "; check the path" : meant)));
}

Scene load_scene(const SceneRequest& request, const Warn& warn) {
    const BuiltinScene* builtin = find_builtin_scene(request.source);
    Scene scene = builtin ? build(*builtin, request.detail) : load_file(request, warn);
    if (!builtin) light_file(scene, request, warn);
    if (request.sky == SceneRequest::Sky::off) {
        scene.sky = {0, 0, 0};
        scene.sun.reset();
    }
    choose_camera(scene, request);
    return scene;
}

}  // namespace raycache::tracer
