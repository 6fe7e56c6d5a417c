#include "tracer/quality/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tracer/paths/integrators/integrator.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint64_t first_seed = 0x7265666572656e63;  // "referenc"
constexpr std::uint64_t seeds = std::uint64_t{1} << 26;   // enough for 2^37 samples
constexpr std::uint64_t block = 4096;  ///< samples rendered together: a float sum of more would lose digits

using Sum = std::array<double, 3>;

/// The mean of `spp` samples per pixel. Uses the seeds `seed`, `seed` + 2, …
std::vector<Sum> render_half(const PreparedScene& scene, const ReferenceSettings& settings, std::uint64_t spp,
                             std::uint64_t seed, const std::function<void(std::uint64_t)>& progress) {
    std::vector<Sum> mean(std::size_t{settings.width} * settings.height);
    for (std::uint64_t done = 0; done < spp; done += block, seed += 2) {
        RenderSettings part{settings.width, settings.height, settings.paths, {}, settings.clamp};
        part.strategy.decorrelation = settings.decorrelation;
        part.strategy.sequence = settings.sequence;
        part.strategy.samples.spp = std::min(block, spp - done);
        part.strategy.samples.seed = seed;
        const Image image = render(scene, part, progress);
        const double share = static_cast<double>(part.strategy.samples.spp) / static_cast<double>(spp);
        for (std::size_t p = 0; p < mean.size(); ++p)
            for (int c = 0; c < 3; ++c) mean[p][static_cast<std::size_t>(c)] += share * double{image.pixels[p][c]};
    }
    return mean;
}

std::string text(Vec3 v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

}  // namespace

std::string reference_key(const PreparedScene& prepared, const ReferenceSettings& settings) {
    const Scene& scene = prepared.scene();
    const Camera& camera = prepared.camera();
    // A field that is not part of the key would let one picture stand for another.
    const auto& [bounces, roulette, reflections, transmissions, lights, integrator, parameters] = settings.paths;
    static_assert(sizeof(Sun) == 28, "put the new field of Sun into the key below");
    std::string key = fmt::format(
        "raycache reference 3; scene {:016x}, {} triangles, sky {}; camera eye {} forward {} up {} fov {}; {}x{} "
        "pixels; "
        "{} bounces, {} reflections, {} transmissions, lights {}{}; {} {}, {} samples per pixel, blocks of {}, seed "
        "{:x}",
        scene.hash, scene.triangle_count(), text(scene.sky), text(camera.eye), text(camera.forward), text(camera.up),
        camera.vertical_fov, settings.width, settings.height, bounces, reflections, transmissions, to_string(lights),
        roulette ? ", roulette" : "", settings.decorrelation, settings.sequence, settings.spp, block, first_seed);
    if (scene.sun)
        key += fmt::format("; sun {} irradiance {} radius {}", text(scene.sun->direction), text(scene.sun->irradiance),
                           scene.sun->angular_radius);
    if (integrator != default_integrator) key += fmt::format("; integrator {}", integrator);
    for (const auto& [name, value] : parameters.given())
        if (integrator_entry(integrator).has_parameter(name)) key += fmt::format("; {} {}", name, value);
    if (settings.clamp) key += fmt::format("; samples clamped to {}", *settings.clamp);
    return key;
}

Reference render_reference(const PreparedScene& scene, const ReferenceSettings& settings,
                           const std::function<void(std::uint64_t)>& progress) {
    if (settings.spp < 2 || settings.spp / block > seeds / 2)
        throw UsageError(fmt::format("reference: expected 2 to {} samples per pixel, found {}; choose another number",
                                     seeds / 2 * block, settings.spp));
    constexpr std::uint64_t pixel_bytes = 2 * sizeof(Sum) + 3 * sizeof(Vec3);  // two halves, what is made of them
    MemoryBudget().check(pixel_bytes * settings.width * settings.height,
                         fmt::format("{} x {} pixels", settings.width, settings.height), "the reference picture");
    const std::uint64_t half = (settings.spp + 1) / 2;
    const auto a = render_half(scene, settings, half, first_seed, progress);
    const auto b = render_half(scene, settings, half, first_seed + 1, progress);
    Reference reference{{settings.width, settings.height, {}}, {settings.width, settings.height, {}}, {}};
    for (std::size_t p = 0; p < a.size(); ++p) {
        std::array<float, 3> mean, difference;
        for (std::size_t c = 0; c < 3; ++c) {
            mean[c] = static_cast<float>((a[p][c] + b[p][c]) / 2);
            difference[c] = static_cast<float>((a[p][c] - b[p][c]) / 2);
        }
        reference.mean.pixels.push_back({mean[0], mean[1], mean[2]});
        reference.half_difference.pixels.push_back({difference[0], difference[1], difference[2]});
    }
    reference.key = reference_key(scene, settings);
    return reference;
}

void check_seeds(std::uint64_t first, std::uint64_t count) {
    if (first - first_seed < seeds || first_seed - first < count)  // modulo 2^64
        throw UsageError(
            fmt::format("--seed {}: expected a seed that the reference does not use, found one of {} to {}; "
                        "choose a smaller one",
                        first, first_seed, first_seed + seeds - 1));
}

}  // namespace raycache::tracer
