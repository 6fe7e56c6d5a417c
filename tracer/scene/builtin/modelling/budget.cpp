#include "tracer/scene/builtin/modelling/budget.hpp"

#include <cmath>
#include <vector>

namespace raycache::tracer::modelling {
namespace {

struct Size {
    std::size_t vertices, triangles;
};

Size size_of(const Part& part, Fineness fine) {
    MeshBuilder counter = MeshBuilder::counter();
    part.build(counter, fine);
    return {counter.vertices(), counter.triangles()};
}

Fineness fit(const Part& part, double triangles) {
    double low = 0.2, high = 24;
    while (high > 1.01 * low) {
        const double middle = std::sqrt(low * high);
        (static_cast<double>(size_of(part, {middle}).triangles) <= triangles ? low : high) = middle;
    }
    return {low};
}

}  // namespace

MeshBuilder build_within(std::uint64_t triangles, std::span<const Part> parts, const Remainder& remainder) {
    std::vector<Fineness> fineness;
    Size built{0, 0};
    for (const Part& part : parts) {
        fineness.push_back(fit(part, part.share * static_cast<double>(triangles)));
        const Size size = size_of(part, fineness.back());
        built.vertices += size.vertices;
        built.triangles += size.triangles;
    }
    const std::size_t left = triangles > built.triangles ? triangles - built.triangles : 0;

    MeshBuilder b;
    b.reserve(built.vertices + remainder.vertices(left), triangles);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].build(b, fineness[i]);
    remainder.build(b, left);
    return b;
}

}  // namespace raycache::tracer::modelling
