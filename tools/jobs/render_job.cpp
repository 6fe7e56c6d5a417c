#include "tools/jobs/render_job.hpp"

#include "tools/jobs/costs.hpp"
#include "tools/jobs/exposure.hpp"
#include "tracer/render.hpp"

namespace raycache::tools {

tracer::CaptureSettings RenderJob::capture() const {
    tracer::check_image_name(output);
    const Resolution size = parse_resolution(sampling.resolution);
    tracer::CaptureSettings settings;
    settings.width = size.width;
    settings.height = size.height;
    settings.paths = sampling.paths();
    settings.strategy = sampling.strategy(strategy.sequence, to_string(strategy.strategy), strategy.spp);
    tracer::check_clamp(clamp);
    const tracer::SamplingStrategy check(settings.strategy, tracer::sample_dimensions(settings.paths));
    return settings;
}

RenderResult run(const RenderJob& job, Observer& observer) {
    const tracer::CaptureSettings c = job.capture();
    warn_of_strategies({c}, observer);
    const tracer::RenderSettings settings{c.width, c.height, c.paths, c.strategy, job.clamp};
    check_outputs({job.output}, observer.warning());
    const std::uint64_t paths = std::uint64_t{c.width} * c.height * job.strategy.spp;
    observer.expect("render", Work::render, render_cost(paths, settings.paths.bounces));
    const auto scene = job.scene.prepare({job.output}, observer);
    const Stage stage(observer, "render", paths, "paths");
    const tracer::Image image = tracer::render(*scene, settings, [&](std::uint64_t done) { stage.add(done, done); });
    const float exposure = job.exposure ? *job.exposure : automatic_exposure(image);
    tracer::write_image(job.output, image, exposure);
    return {c.width, c.height, exposure};
}

}  // namespace raycache::tools
