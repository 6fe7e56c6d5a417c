// The Cornell box against a path tracer that shares nothing with ours but the scene's triangles, reflectances and
// camera: every triangle tested, double arithmetic, directions uniform over the hemisphere, light found by chance
// alone.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/real_data.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/render.hpp"

using namespace raycache::tracer;

namespace {

using D3 = std::array<double, 3>;
D3 of(Vec3 v) { return {v.x, v.y, v.z}; }
D3 operator+(D3 a, D3 b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
D3 operator-(D3 a, D3 b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
D3 operator*(D3 a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(D3 a, D3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
D3 cross(D3 a, D3 b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
D3 unit(D3 a) { return a * (1 / std::sqrt(dot(a, a))); }

struct Facet {
    D3 corner, edge1, edge2, normal, color, emission;
};

class NaiveTracer {
public:
    explicit NaiveTracer(const Scene& scene) {
        for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
            const D3 a = of(scene.positions[scene.indices[3 * t]]), b = of(scene.positions[scene.indices[3 * t + 1]]),
                     c = of(scene.positions[scene.indices[3 * t + 2]]);
            const Material& m = scene.materials[scene.material_of[t]];
            facets_.push_back({a, b - a, c - a, unit(cross(b - a, c - a)), of(m.base_color), of(m.emission)});
        }
    }

    /// Radiance along one random path of `bounces` bounces, whose last vertex still sees light.
    D3 radiance(D3 origin, D3 direction, unsigned bounces) {
        D3 sum{}, weight{1, 1, 1};
        for (unsigned segment = 0; segment <= bounces + 1; ++segment) {
            double nearest = 1e300;
            const Facet* hit = nullptr;
            for (const Facet& f : facets_)
                if (const double t = distance(f, origin, direction); t > 1e-6 && t < nearest) {
                    nearest = t;
                    hit = &f;
                }
            if (hit == nullptr) break;
            for (std::size_t c = 0; c < 3; ++c) sum[c] += weight[c] * hit->emission[c];
            const D3 normal = dot(hit->normal, direction) > 0 ? hit->normal * -1 : hit->normal;
            origin = origin + direction * nearest + normal * 1e-5;
            const double z = number_(random_), angle = 2 * std::numbers::pi * number_(random_);
            const D3 tangent = unit(cross(std::fabs(normal[0]) > 0.5 ? D3{0, 1, 0} : D3{1, 0, 0}, normal));
            const double r = std::sqrt(1 - z * z);
            direction = tangent * (r * std::cos(angle)) + cross(normal, tangent) * (r * std::sin(angle)) + normal * z;
            // color / pi * cosine over the density 1 / (2 pi)
            for (std::size_t c = 0; c < 3; ++c) weight[c] *= hit->color[c] * 2 * z;
        }
        return sum;
    }
    double number() { return number_(random_); }

private:
    /// Along the ray to the facet, from either side, or -1. T. Möller, B. Trumbore, 1997.
    static double distance(const Facet& f, D3 origin, D3 direction) {
        const D3 p = cross(direction, f.edge2);
        const double determinant = dot(f.edge1, p);
        if (determinant == 0) return -1;
        const D3 s = origin - f.corner, q = cross(s, f.edge1);
        const double u = dot(s, p) / determinant, v = dot(direction, q) / determinant;
        return u < 0 || v < 0 || u + v > 1 ? -1 : dot(f.edge2, q) / determinant;
    }

    std::vector<Facet> facets_;
    std::mt19937_64 random_{1};
    std::uniform_real_distribution<double> number_{0, 1};
};

}  // namespace

TEST_CASE("independent render: the Cornell box is that of a naive path tracer, however lights are sampled",
          "[slow][data]") {
    const auto path = raycache::test::real_scene("cornell_box.glb");
    if (!path) return;
    constexpr std::uint32_t side = 12, samples = 20000, bounces = 3;
    const PreparedScene prepared(load_gltf(*path, nullptr), {});
    const Camera& camera = prepared.camera();
    const D3 forward = of(camera.forward), right = unit(cross(forward, of(camera.up))), up = cross(right, forward);
    const double half = std::tan(double{camera.vertical_fov} * std::numbers::pi / 360);
    NaiveTracer naive(prepared.scene());
    std::vector<D3> expected, variance;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            D3 sum{}, squares{};
            for (std::uint32_t i = 0; i < samples; ++i) {
                const double sx = ((x + naive.number()) / side * 2 - 1) * half,
                             sy = (1 - (y + naive.number()) / side * 2) * half;
                const D3 one = naive.radiance(of(camera.eye), unit(forward + right * sx + up * sy), bounces);
                for (std::size_t c = 0; c < 3; ++c) {
                    sum[c] += one[c] / samples;
                    squares[c] += one[c] * one[c] / samples;
                }
            }
            expected.push_back(sum);
            variance.push_back((squares - D3{sum[0] * sum[0], sum[1] * sum[1], sum[2] * sum[2]}) * (1.0 / samples));
        }
    for (const LightSampling lights : {LightSampling::bsdf, LightSampling::nee, LightSampling::mis}) {
        RenderSettings settings{side, side, {}, {}};
        settings.paths.bounces = bounces;
        settings.paths.lights = lights;
        settings.strategy.decorrelation = "cranley-patterson";
        settings.strategy.samples.spp = 16384;
        const Image ours = render(prepared, settings, {});
        double total = 0, expected_total = 0, total_variance = 0;
        int beyond = 0;
        for (std::size_t p = 0; p < expected.size(); ++p)
            for (int c = 0; c < 3; ++c) {
                const auto channel = static_cast<std::size_t>(c);
                const double difference = double{ours.pixels[p][c]} - expected[p][channel];
                beyond += std::fabs(difference) > 4.5 * std::sqrt(variance[p][channel]) + 1e-3;
                total += double{ours.pixels[p][c]};
                expected_total += expected[p][channel];
                total_variance += variance[p][channel];
            }
        INFO(to_string(lights) << ": " << total << ", expected " << expected_total << " +- "
                               << std::sqrt(total_variance));
        CHECK(beyond == 0);
        CHECK(std::fabs(total - expected_total) < 4 * std::sqrt(total_variance) + 1e-3 * expected_total);
        CHECK(std::sqrt(total_variance) < 0.01 * expected_total);  // the test can tell a per cent
    }
}
