// ssao: screen-space ambient occlusion, as a pass over the depth and normal buffers of a picture that has been drawn
// before (M. Mittring, "Finding next gen: CryEngine 2", SIGGRAPH 2007 course 28). A sample reads the pixel's own depth
// and normal, marches one ray from there (screen_ray.hpp) and is 0 where something blocks it, else 1. Directions have
// density cos(theta) / pi above the surface, so the mean over N samples is what `ao` computes, as far as the picture
// knows the scene:
//   A(p) = 1/N * sum of V(p, w_i)
// (T. Ritschel, T. Grosch, H.-P. Seidel, "Approximating dynamic global illumination in image space", I3D 2009, whose
// points on a direction are here the steps of a march; L. Bavoil, M. Sainz, R. Dimitrov, "Image-space horizon-based
// ambient occlusion", SIGGRAPH 2008 talks, march too but integrate the horizon.) Sky is 1, and reads its depth alone.
//
// The trace: a ray of a pixel is what a thread of the pass does for one direction. Lanes end where they are blocked or
// leave the picture; all steps of a warp are taken together. How the buffers came about is not in it.
//
// Dimensions as those of `path`: (4,5) direction, 6 the offset of the steps; 0 to 3 are not read, since depth is stored
// at the centres of pixels.
#include <bit>

#include "tracer/paths/ambient_radius.hpp"
#include "tracer/paths/depth_buffer.hpp"
#include "tracer/paths/directions.hpp"
#include "tracer/paths/integrators/integrator.hpp"
#include "tracer/paths/screen_ray.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint32_t march_dimension = 4, offset_dimension = 6, ssao_dimensions = 7;
constexpr std::uint8_t depth_region = 0, normal_region = 1;
constexpr traces::RayType marched = traces::RayType::shadow;
constexpr const char* ssao_topic = "ssao";

constexpr ParameterEntry steps_parameter{.name = "steps",
                                         .description = "depths that a ray reads on its way, at most",
                                         .fallback = "8",
                                         .label = "the number of steps",
                                         .remedy = "give --steps 8, the default",
                                         .whole = true,
                                         .least = 1,
                                         .most = 1024,
                                         .topic = ssao_topic};
constexpr ParameterEntry thickness_parameter{
    .name = "thickness",
    .description = "how far behind a surface of the picture a ray is blocked by it, in metres, or 'auto': the radius",
    .fallback = "auto",
    .label = "the thickness",
    .remedy = "give --thickness such as 0.5",
    .most = 1e18,
    .word = "auto",
    .topic = ssao_topic};
constexpr ParameterEntry layout_parameter{
    .name = "depth-layout",
    .description = "how depths and normals lie in memory: linear, row after row, or tiled, in tiles of 8 x 8 pixels",
    .fallback = "linear",
    .label = "depth layout",
    .remedy = "give --depth-layout linear, the default",
    .choices = {"linear", "tiled"},
    .topic = ssao_topic};
constexpr ParameterEntry bytes_parameter{.name = "depth-bytes",
                                         .description = "of a depth: 4, a float, or 2, a half",
                                         .fallback = "4",
                                         .label = "number of depth bytes",
                                         .remedy = "give --depth-bytes 4, the default",
                                         .choices = {"2", "4"},
                                         .topic = ssao_topic};

DepthFormat depth_format_of(const Parameters& parameters) {
    return {parameters.word(layout_parameter) == "tiled" ? DepthLayout::tiled : DepthLayout::linear,
            parameters.word(bytes_parameter) == "2" ? 2U : 4U};
}

ScreenMarch march_of(const Scene& scene, const PathSettings& settings) {
    const float radius = radius_of(scene, settings);
    const Parameters& given = settings.parameters;
    return {radius, given.is_word(thickness_parameter) ? radius : static_cast<float>(given.real(thickness_parameter)),
            static_cast<std::uint32_t>(given.whole(steps_parameter))};
}

struct ScreenSpace final : IntegratorData {
    explicit ScreenSpace(const IntegratorSetup& setup)
        : march(march_of(setup.scene, setup.settings)),
          depths(draw_depth(setup.scene, setup.camera, setup.embree(), depth_format_of(setup.settings.parameters))) {}
    std::vector<traces::Region> regions() const override { return depths.regions(); }

    ScreenMarch march;
    DepthBuffer depths;
};

class ScreenSpaceOcclusion final : public Integrator {
public:
    explicit ScreenSpaceOcclusion(const IntegratorInput& input)
        : camera_(input.camera),
          strategy_(input.strategy),
          traversal_(input.traversal),
          march_(static_cast<const ScreenSpace*>(input.data)->march),
          depths_(static_cast<const ScreenSpace*>(input.data)->depths) {}

    void trace(std::uint32_t mask, const std::array<PathLane, PathLanes::count>& jobs,
               std::array<Vec3, PathLanes::count>& radiance) override {
        std::uint32_t elements[PathLanes::count];
        std::uint32_t alive = 0;
        for (std::uint32_t m = mask; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            elements[l] = depths_.element(jobs[l].x, jobs[l].y);
            radiance[l] = {1, 1, 1};
            if (depths_.reciprocal(elements[l]) > 0) alive |= 1U << l;
        }
        traversal_.start(mask, marched, 0);
        traversal_.read_region(mask, marched, 0, depth_region, elements);
        if (alive == 0) return;
        traversal_.read_region(alive, marched, 0, normal_region, elements);
        for (std::uint32_t m = alive; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            const Vec3 local =
                cosine_hemisphere({number(jobs[l], march_dimension), number(jobs[l], march_dimension + 1)});
            rays_[l] = ScreenRay(depths_, camera_, march_, jobs[l].x, jobs[l].y,
                                 to_world(local, depths_.normal(elements[l])), number(jobs[l], offset_dimension));
        }
        for (std::uint32_t i = 0; i < march_.steps && alive != 0; ++i) alive = step(i, alive, elements, radiance);
    }

private:
    /// Takes one step of each ray; returns the lanes that go on.
    std::uint32_t step(std::uint32_t i, std::uint32_t alive, std::uint32_t* elements,
                       std::array<Vec3, PathLanes::count>& radiance) {
        std::uint32_t x[PathLanes::count], y[PathLanes::count];
        std::uint32_t inside = 0, blocked = 0;
        for (std::uint32_t m = alive; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            if (!rays_[l].step(i, depths_, march_, x[l], y[l])) continue;
            elements[l] = depths_.element(x[l], y[l]);
            inside |= 1U << l;
        }
        if (inside == 0) return 0;
        traversal_.read_region(inside, marched, 0, depth_region, elements);
        for (std::uint32_t m = inside; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            if (!rays_[l].is_blocked(depths_.reciprocal(elements[l]), x[l], y[l], depths_, camera_, march_)) continue;
            radiance[l] = {};
            blocked |= 1U << l;
        }
        return inside & ~blocked;
    }

    float number(const PathLane& lane, std::uint32_t dimension) const {
        return to_unit_float(strategy_.value(lane.base[dimension], lane.pixel, lane.sample, dimension));
    }

    const CameraRays& camera_;
    const SamplingStrategy& strategy_;
    Traversal& traversal_;
    const ScreenMarch& march_;
    const DepthBuffer& depths_;
    ScreenRay rays_[PathLanes::count];
};

}  // namespace

IntegratorEntry ssao_integrator() {
    return {.name = "ssao",
            .description =
                "screen-space ambient occlusion: rays marched through a depth buffer (--radius --steps "
                "--thickness --depth-layout --depth-bytes)",
            .dimensions = [](const PathSettings&) -> std::uint32_t { return ssao_dimensions; },
            .make = [](const IntegratorInput& input) -> std::unique_ptr<Integrator> {
                return std::make_unique<ScreenSpaceOcclusion>(input);
            },
            .stages = nullptr,
            .follows_light = false,
            .walks_bvh = false,
            .parameters = {radius_parameter, steps_parameter, thickness_parameter, layout_parameter, bytes_parameter},
            .prepare = [](const IntegratorSetup& setup) -> std::shared_ptr<const IntegratorData> {
                return std::make_shared<ScreenSpace>(setup);
            }};
}

}  // namespace raycache::tracer
