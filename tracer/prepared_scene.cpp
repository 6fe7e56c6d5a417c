#include "tracer/prepared_scene.hpp"

#include <fmt/format.h>

namespace raycache::tracer {

std::shared_ptr<const IntegratorData> PreparedScene::integrator_data(const CameraRays& camera,
                                                                     const PathSettings& settings) const {
    const IntegratorEntry& entry = integrator_entry(settings.integrator);
    if (entry.prepare == nullptr) return nullptr;
    std::string key = fmt::format("{} {}x{}", entry.name, camera.width(), camera.height());
    for (const ParameterEntry& p : entry.parameters)
        key += fmt::format(" {}={}", p.name, settings.parameters.text(p.name));
    const std::lock_guard lock(shared_->data_mutex);
    std::shared_ptr<const IntegratorData>& kept = shared_->data[key];
    if (!kept) kept = entry.prepare({scene(), camera, settings, [this]() -> const EmbreeScene& { return embree(); }});
    return kept;
}

}  // namespace raycache::tracer
