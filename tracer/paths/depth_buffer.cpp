#include "tracer/paths/depth_buffer.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "tracer/paths/surface.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tracer {
namespace {

constexpr float smallest_half = 0x1p-24F;

std::uint32_t tiles_of(std::uint32_t pixels) { return (pixels + DepthBuffer::tile - 1) / DepthBuffer::tile; }

struct SeenSurface {
    float depth = 0;  ///< 0: sky
    Vec3 normal;
};

}  // namespace

DepthBuffer::DepthBuffer(std::uint32_t width, std::uint32_t height, DepthFormat format, float near)
    : width_(width), height_(height), tiles_in_row_(tiles_of(width)), format_(format), near_(near) {
    const std::size_t count = format.layout == DepthLayout::linear
                                  ? std::size_t{width} * height
                                  : std::size_t{tiles_in_row_} * tiles_of(height) * (tile * tile);
    MemoryBudget().check(count * (sizeof(float) + sizeof(std::uint32_t)), fmt::format("{} x {} pixels", width, height),
                         "the depth buffer");
    reciprocals_.resize(count);
    normals_.resize(count);
}

void DepthBuffer::set(std::uint32_t element, float depth, Vec3 normal) {
    const float reciprocal = near_ / depth;
    reciprocals_[element] = format_.bytes == 4 ? std::max(reciprocal, std::numeric_limits<float>::min())
                                               : std::max(rounded_to_half(reciprocal), smallest_half);
    normals_[element] = pack_unit(normal);
}

std::vector<traces::Region> DepthBuffer::regions() const {
    traces::Region depths, normals;
    depths.kind = traces::ObjectKind::depth;
    depths.element_size = depths.stride = format_.bytes;
    normals.kind = traces::ObjectKind::normal;
    normals.element_size = normals.stride = sizeof(std::uint32_t);
    depths.count = normals.count = elements();
    return {depths, normals};
}

DepthBuffer draw_depth(const Scene& scene, const CameraRays& camera, const EmbreeScene& embree, DepthFormat format) {
    const std::uint32_t width = camera.width(), height = camera.height();
    MemoryBudget().check(std::uint64_t{width} * height * sizeof(SeenSurface),
                         fmt::format("{} x {} pixels", width, height), "the depth buffer");
    std::vector<SeenSurface> seen(std::size_t{width} * height);
    const auto draw_row = [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const Ray ray = camera.ray(x, y, {0.5F, 0.5F});
            const Hit hit = embree.intersect(ray);
            if (!hit.found()) continue;
            const Vec3 normal = surface_at(scene, ray, hit).geometric_normal;
            if (!(dot(normal, normal) > 0)) continue;
            seen[std::size_t{y} * width + x] = {hit.t * camera.to_view(ray.direction).z,
                                                normalize(camera.to_view(normal))};
        }
    };
    // Others may wait for this buffer: a thread that waits here must not begin a task of theirs.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, height), [&](const auto& rows) {
            for (std::uint32_t y = rows.begin(); y != rows.end(); ++y) draw_row(y);
        });
    });
    float near = std::numeric_limits<float>::infinity();
    for (const SeenSurface& s : seen)
        if (s.depth > 0) near = std::min(near, s.depth);
    DepthBuffer buffer(width, height, format, std::isfinite(near) ? near : 1.0F);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            if (const SeenSurface& s = seen[std::size_t{y} * width + x]; s.depth > 0)
                buffer.set(buffer.element(x, y), s.depth, s.normal);
    return buffer;
}

}  // namespace raycache::tracer
