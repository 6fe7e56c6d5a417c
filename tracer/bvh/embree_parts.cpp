#include "tracer/bvh/embree_parts.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "tracer/bvh/near_plane.hpp"
#include "tracer/scene/cutout.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

EmbreeParts::EmbreeParts(const Scene& data, const TexelLayout* holes) : scene_data_(&data), texels_(holes) {
    device_.reset(rtcNewDevice("set_affinity=0"));
    if (!device_) throw Error("Embree cannot start on this processor");
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    for (std::uint32_t t = 0; t < data.triangle_count(); ++t)
        if (const auto part = part_of(t); part != plain) parts_[part].triangles.push_back(t);
    const std::size_t filtered = parts_[holed].triangles.size() + parts_[giant].triangles.size();
    for (std::uint32_t t = 0; filtered != 0 && t < data.triangle_count(); ++t)
        if (part_of(t) == plain) parts_[plain].triangles.push_back(t);
    if (filtered < data.triangle_count()) attach(plain, data.triangle_count() - filtered);
    for (const auto part : {holed, giant})
        if (!parts_[part].triangles.empty()) attach(part, parts_[part].triangles.size());
    // One thread: with more, the order of triangles in the tree, and with it which of two coinciding ones is found,
    // depends on timing.
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    tbb::task_arena(1).execute([&] { rtcCommitScene(scene_.get()); });
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
        throw Error(data.name + ": Embree could not build its BVH: is there enough memory?");
}

std::uint32_t EmbreeParts::part_of(std::uint32_t triangle) const {
    Box box;
    for (std::size_t k = 0; k < 3; ++k) box.add(vertex(triangle, k));
    if (max_component(box.upper - box.lower) > scene_data_->giant_above) return giant;
    const Material& material = scene_data_->materials[scene_data_->material_of[triangle]];
    return texels_ != nullptr && material.may_have_holes() ? holed : plain;
}

Vec3 EmbreeParts::vertex(std::uint32_t triangle, std::size_t k) const {
    return scene_data_->positions[scene_data_->indices[3 * std::size_t{triangle} + k]];
}

void EmbreeParts::attach(std::uint32_t part, std::size_t count) {
    const RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::vector<Vec3>& positions = scene_data_->positions;
    // Embree reads 16 bytes of each vertex: its own copy is padded.
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), positions.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
    if (vertices == nullptr || indices == nullptr) throw Error("Embree: out of memory");
    for (std::size_t i = 0; i < positions.size(); ++i) {
        vertices[3 * i] = positions[i].x;
        vertices[3 * i + 1] = positions[i].y;
        vertices[3 * i + 2] = positions[i].z;
    }
    for (std::uint32_t i = 0; i < count; ++i)
        std::copy_n(&scene_data_->indices[std::size_t{3} * parts_[part].triangle(i)], 3, indices + std::size_t{3} * i);
    if (part != plain) {
        const auto filter = part == holed ? skip_holes : skip_behind;
        rtcSetGeometryUserData(mesh, &parts_[part]);
        rtcSetGeometryIntersectFilterFunction(mesh, filter);
        rtcSetGeometryOccludedFilterFunction(mesh, filter);
    }
    rtcCommitGeometry(mesh);
    rtcAttachGeometryByID(scene_.get(), mesh, part);
    rtcReleaseGeometry(mesh);
}

void EmbreeParts::skip_holes(const RTCFilterFunctionNArguments* arguments) {
    const Part& part = *static_cast<const Part*>(arguments->geometryUserPtr);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        const Scene& scene = *part.owner->scene_data_;
        const std::uint32_t triangle = part.triangle(RTCHitN_primID(arguments->hit, arguments->N, i));
        if (!scene.materials[scene.material_of[triangle]].may_have_holes()) continue;
        const Cutout cutout =
            cutout_at(scene, *part.owner->texels_, triangle, RTCHitN_u(arguments->hit, arguments->N, i),
                      RTCHitN_v(arguments->hit, arguments->N, i));
        if (!cutout.solid) arguments->valid[i] = 0;
    }
}

/// Hits of giants that lie behind the ray's start in truth; then what skip_holes() skips.
void EmbreeParts::skip_behind(const RTCFilterFunctionNArguments* arguments) {
    const Part& part = *static_cast<const Part*>(arguments->geometryUserPtr);
    const EmbreeParts& impl = *part.owner;
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        RTCRayN* const ray = arguments->ray;
        const unsigned n = arguments->N;
        const Vec3d origin(RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i));
        const Vec3d direction(RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i));
        const std::uint32_t triangle = part.triangle(RTCHitN_primID(arguments->hit, n, i));
        const Vec3d a = impl.vertex(triangle, 0), b = impl.vertex(triangle, 1), c = impl.vertex(triangle, 2);
        const double reach = std::max({length(a - origin), length(b - origin), length(c - origin)});
        if (double{RTCRayN_tfar(ray, n, i)} * length(direction) >= double{near_share} * reach) continue;
        if (!(plane_distance(a, b, c, origin, direction) > double{RTCRayN_tnear(ray, n, i)})) arguments->valid[i] = 0;
    }
    if (impl.texels_ != nullptr) skip_holes(arguments);
}

/// What Embree takes: beyond it asserts, or where those are off answers at random. A ray that rounding or a scene
/// of extreme size has spoilt meets nothing.
bool EmbreeParts::takes(const Ray& ray) {
    constexpr float most = 1.844e18F;  // FLT_LARGE of Embree 3
    const auto within = [](Vec3 v) { return std::abs(v.x) < most && std::abs(v.y) < most && std::abs(v.z) < most; };
    return within(ray.origin) && within(ray.direction) && ray.t_min >= 0 && ray.t_min <= ray.t_max;
}

RTCRay EmbreeParts::query(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            ray.t_min,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.t_max,
            ~0U,
            0,
            0};
}

}  // namespace raycache::tracer
