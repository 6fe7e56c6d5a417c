// ao: ambient occlusion in the world. From where a camera ray ends one ray goes into the hemisphere above the surface;
// the sample is 1 where it meets nothing within `radius`, else 0. With directions of density cos(theta) / pi the mean is
//   A(p, n) = 1/pi * integral over the hemisphere of V(p, w) (n . w) dw,  V = 1 where nothing is within the radius
// (S. Zhukov, A. Iones, G. Kronin, "An ambient light illumination model", EGWR 1998, with a step for their function of
// distance; H. Landis, "Production-ready global illumination", SIGGRAPH 2002 course 16, without a radius). Camera rays
// that leave the scene are 1. n is the triangle's own normal; holes of alphaMode MASK are holes, BLEND blocks.
//
// Dimensions as those of `path`, so that what strategies say of them holds here too: (0,1) position in the pixel, (4,5)
// direction. (2,3) is not read.
#include <bit>

#include "tracer/paths/ambient_radius.hpp"
#include "tracer/paths/directions.hpp"
#include "tracer/paths/integrators/integrator.hpp"
#include "tracer/paths/surface.hpp"

namespace raycache::tracer {
namespace {

constexpr unsigned camera_dimension = 0, direction_dimension = 4, ao_dimensions = 6;

struct AmbientReach final : IntegratorData {
    explicit AmbientReach(float metres) : radius(metres) {}
    float radius;
};

class AmbientOcclusion final : public Integrator {
public:
    explicit AmbientOcclusion(const IntegratorInput& input)
        : scene_(input.scene),
          camera_(input.camera),
          strategy_(input.strategy),
          traversal_(input.traversal),
          radius_(static_cast<const AmbientReach*>(input.data)->radius) {}

    void trace(std::uint32_t mask, const std::array<PathLane, PathLanes::count>& jobs,
               std::array<Vec3, PathLanes::count>& radiance) override {
        Ray rays[PathLanes::count];
        Hit hits[PathLanes::count];
        for (std::uint32_t m = mask; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            rays[l] = camera_.ray(jobs[l].x, jobs[l].y, pair(jobs[l], camera_dimension));
            radiance[l] = {1, 1, 1};
        }
        traversal_.closest(mask, traces::RayType::camera, 0, rays, hits);
        std::uint32_t found = 0;
        for (std::uint32_t m = mask; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            if (!hits[l].found()) continue;
            const Surface s = surface_at(scene_, rays[l], hits[l]);
            const Vec3 local = cosine_hemisphere(pair(jobs[l], direction_dimension));
            const Vec3 direction = to_world(local, s.geometric_normal);
            rays[l] = {s.leave(direction), direction, 0, radius_};
            found |= 1U << l;
        }
        if (found == 0) return;
        for (std::uint32_t m = traversal_.occluded(found, traces::RayType::shadow, 0, rays); m != 0; m &= m - 1)
            radiance[static_cast<unsigned>(std::countr_zero(m))] = {};
    }

private:
    Vec2 pair(const PathLane& lane, std::uint32_t dimension) const {
        const auto number = [&](std::uint32_t d) {
            return to_unit_float(strategy_.value(lane.base[d], lane.pixel, lane.sample, d));
        };
        return {number(dimension), number(dimension + 1)};
    }

    const Scene& scene_;
    const CameraRays& camera_;
    const SamplingStrategy& strategy_;
    Traversal& traversal_;
    float radius_;
};

}  // namespace

IntegratorEntry ao_integrator() {
    return {.name = "ao",
            .description = "ambient occlusion: one ray from each camera hit into its hemisphere (--radius)",
            .dimensions = [](const PathSettings&) -> std::uint32_t { return ao_dimensions; },
            .make = [](const IntegratorInput& input) -> std::unique_ptr<Integrator> {
                return std::make_unique<AmbientOcclusion>(input);
            },
            .stages = nullptr,
            .follows_light = false,
            .parameters = {radius_parameter},
            .prepare = [](const IntegratorSetup& setup) -> std::shared_ptr<const IntegratorData> {
                return std::make_shared<AmbientReach>(radius_of(setup.scene, setup.settings));
            }};
}

}  // namespace raycache::tracer
