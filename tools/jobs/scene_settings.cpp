#include "tools/jobs/scene_settings.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "tools/jobs/bvh_cache.hpp"
#include "tools/jobs/costs.hpp"
#include "tracer/scene/scene_name.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

tracer::Vec3d parse_vector(const std::string& text, const char* option) {
    tracer::Vec3d v;
    double* out[3] = {&v.x, &v.y, &v.z};
    const char* at = text.data();
    const char* end = at + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [stop, error] = std::from_chars(at, end, *out[i]);
        const bool last = i == 2;
        if (error != std::errc{} || !std::isfinite(*out[i]) || (last ? stop != end : stop == end || *stop != ','))
            throw UsageError(fmt::format("{} '{}'; expected three numbers X,Y,Z such as 1.5,2,-3", option, text));
        at = stop + 1;
    }
    return v;
}

tracer::SceneRequest::Sky parse_sky(const std::string& text) {
    if (text == "auto") return tracer::SceneRequest::Sky::automatic;
    if (text == "on") return tracer::SceneRequest::Sky::on;
    if (text == "off") return tracer::SceneRequest::Sky::off;
    throw UsageError(fmt::format("--sky '{}'; expected one of: auto, on, off", text));
}

tracer::BvhSource bvh_source(const std::string& folder, Observer& observer) {
    if (folder.empty()) return tracer::build_bvh;
    return [folder, warn = observer.warning()](const tracer::Scene& scene, const tracer::BvhSettings& settings) {
        return cached_bvh(folder, scene, settings, warn);
    };
}

}  // namespace

std::unique_ptr<tracer::PreparedScene> SceneSettings::prepare(const FileNames& outputs, Observer& observer) const {
    tracer::bvh_layout_entry(layout);  // before anything takes time
    if (!bvh_cache.empty()) check_bvh_cache(bvh_cache);
    if (!tracer::find_builtin_scene(source)) refuse_overwriting({source}, outputs);
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(source, unknown);
    constexpr std::uint64_t usual_triangles = 300000;
    observer.expect("load", Work::prepare,
                    unknown ? load_cost(0, detail != 0 ? detail : usual_triangles) : load_cost(bytes, bytes / 100));
    const Stage stage(observer, "load");
    tracer::SceneRequest request;
    request.source = source;
    request.detail = detail;
    request.sky = parse_sky(sky);
    request.camera = camera;
    if (!eye.empty()) request.eye = parse_vector(eye, "--eye");
    if (!look_at.empty()) request.look_at = parse_vector(look_at, "--look-at");
    if (fov != 0) request.vertical_fov = fov;
    tracer::BvhSettings bvh;
    bvh.spatial_splits = spatial_splits;
    tracer::Scene scene = tracer::load_scene(request, observer.warning());
    refuse_overwriting(scene.files, outputs);
    return std::make_unique<tracer::PreparedScene>(std::move(scene), bvh, layout, bvh_source(bvh_cache, observer));
}

std::string SceneSettings::command() const {
    std::string text = source;
    if (detail != 0) text += fmt::format(" --detail {}", detail);
    if (!camera.empty()) text += " --camera " + camera;
    if (!eye.empty()) text += " --eye " + eye;
    if (!look_at.empty()) text += " --look-at " + look_at;
    if (fov != 0) text += fmt::format(" --fov {}", fov);
    text += " --sky " + sky;
    if (spatial_splits) text += " --spatial-splits";
    if (layout != tracer::default_layout) text += " --layout " + layout;
    return text;
}

}  // namespace raycache::tools
