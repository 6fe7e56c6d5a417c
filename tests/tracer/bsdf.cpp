// Every BSDF against what must hold for any: it loses no energy where nothing absorbs, it is reciprocal, and it chooses
// directions with the density it states.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "test_meshes.hpp"
#include "tracer/paths/bsdf/bsdf.hpp"
#include "tracer/paths/bsdf/fresnel.hpp"
#include "tracer/paths/bsdf/ggx_albedo.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

constexpr double pi = std::numbers::pi;

struct Case {
    float metallic = 0, roughness = 1, transmission = 0, ior = 1.5F;
    bool thin = true, inside = false;
    float alpha = 1;
    Vec3 color{1, 1, 1};

    Bsdf bsdf() const {
        Material m;
        m.transmission = transmission;
        m.ior = ior;
        m.thin = thin;
        m.alpha_blend = alpha < 1;
        return {m, {color, alpha, metallic, roughness}, inside};
    }
    std::string name() const {
        return "metallic " + std::to_string(metallic) + " roughness " + std::to_string(roughness) + " transmission " +
               std::to_string(transmission) + " ior " + std::to_string(ior) + (thin ? " thin" : " solid") +
               (inside ? " inside" : "") + " alpha " + std::to_string(alpha);
    }
    /// Radiance behind the surface, where it is 1 in front, in a furnace: the square of the index.
    double behind() const {
        if (thin || ior == 0) return 1;
        return inside ? 1 / (double{ior} * double{ior}) : double{ior} * double{ior};
    }
};

Vec3 at_cosine(float cosine, float phi = 0.7F) {
    const float sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// What comes back along `wo` from a furnace, by Hammersley points.
double furnace(const Case& c, Vec3 wo, std::uint32_t points = 16384) {
    const Bsdf bsdf = c.bsdf();
    double sum = 0;
    for (std::uint32_t i = 0; i < points; ++i) {
        float halves = 0, unit = 0.5F;
        for (std::uint32_t bits = i; bits != 0; bits >>= 1, unit /= 2) halves += static_cast<float>(bits & 1U) * unit;
        const BsdfSample s = bsdf.sample(wo, {(static_cast<float>(i) + 0.5F) / static_cast<float>(points), halves});
        sum += double{s.weight.x} * (s.wi.z < 0 && !s.straight ? c.behind() : 1);
    }
    return sum / points;
}

const std::vector<float> roughnesses{0, 1e-8F, 0.01F, 0.02F, 0.05F, 0.1F, 0.3F, 0.6F, 0.99F, 1};
const std::vector<float> cosines{1, 0.8F, 0.5F, 0.2F, 0.05F};

std::vector<Case> rough_cases() {
    return {{0, 0.3F},
            {1, 0.5F},
            {0.5F, 0.8F},
            {0, 1},
            {0, 0.4F, 1, 1.5F, true},
            {0, 0.4F, 1, 1.5F, false},
            {0, 0.4F, 1, 1.5F, false, true},
            {0.3F, 0.5F, 0.5F, 1.8F, false},
            {0.2F, 0.6F, 0.7F, 1.3F, true, false, 0.6F}};
}

}  // namespace

TEST_CASE("bsdf: a white opaque surface returns all light of a furnace, at every roughness, metallic and index",
          "[slow]") {
    for (const float roughness : roughnesses)
        for (const float metallic : {0.0F, 0.5F, 1.0F})
            for (const float ior : {1.0F, 1.5F, 2.4F, 0.0F})
                for (const float cosine : cosines) {
                    const Case c{metallic, roughness, 0, ior};
                    INFO(c.name() << " cosine " << cosine);
                    CHECK(furnace(c, at_cosine(cosine)) == Approx(1).epsilon(0.012));
                }
}

TEST_CASE("bsdf: a coloured opaque surface returns at most what arrives, and a black one its coat alone") {
    for (const float roughness : roughnesses)
        for (const float cosine : cosines) {
            Case c{0, roughness};
            c.color = {0.5F, 0.5F, 0.5F};
            const double half = furnace(c, at_cosine(cosine));
            c.color = {0, 0, 0};
            const double black = furnace(c, at_cosine(cosine));
            INFO(c.name() << " cosine " << cosine);
            CHECK(half < 1.01);
            CHECK(black < half);
            CHECK(black == Approx(roughness < 1 ? ggx_albedo(cosine, roughness).of(0.04F) : 0).margin(0.01));
        }
}

TEST_CASE("bsdf: clear smooth glass returns all light of a furnace, from outside, from inside and as a pane") {
    for (const float roughness : {0.0F, 1e-8F, 0.01F})
        for (const float ior : {1.0F, 1.0001F, 1.33F, 1.5F, 2.4F, 0.0F})
            for (const auto& [thin, inside] : {std::pair{true, false}, {false, false}, {false, true}})
                for (const float cosine : cosines) {
                    const Case c{0, roughness, 1, ior, thin, inside};
                    INFO(c.name() << " cosine " << cosine);
                    CHECK(furnace(c, at_cosine(cosine)) == Approx(1).epsilon(0.01));
                }
}

TEST_CASE("bsdf: rough panes lose what microfacets would scatter twice, rough solids more, none gains") {
    for (const float roughness : {0.02F, 0.1F, 0.3F, 0.6F, 1.0F})
        for (const float cosine : cosines) {
            Case c{0, roughness, 1, 1.5F, true};
            INFO(c.name() << " cosine " << cosine);
            CHECK(furnace(c, at_cosine(cosine)) == Approx(ggx_albedo(cosine, roughness).white()).epsilon(0.02));
            c.thin = false;
            for (const bool inside : {false, true}) {
                c.inside = inside;
                const double kept = furnace(c, at_cosine(cosine));
                INFO("solid, inside " << inside << ": " << kept);
                CHECK(kept < 1.02);
                CHECK(kept > (roughness <= 0.1F ? 0.97 : roughness <= 0.3F ? 0.87 : 0.4));
            }
        }
}

TEST_CASE("bsdf: an index of 1 bends and reflects nothing, smooth or rough, one of 0 reflects everything") {
    for (const float roughness : {0.0F, 0.5F}) {
        const Bsdf nothing = Case{0, roughness, 1, 1.0F, false}.bsdf(), mirror = Case{0, roughness, 1, 0, false}.bsdf();
        Random random(3);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 wo = at_cosine(random.between(0.01F, 1), random.between(0, 6));
            const BsdfSample s = nothing.sample(wo, {random.unit(), random.unit()});
            REQUIRE(length(s.wi + wo) < 1e-5F);
            REQUIRE(s.weight.x == Approx(1));
            REQUIRE(mirror.sample(wo, {random.unit(), random.unit()}).wi.z >= 0);
        }
    }
}

TEST_CASE("bsdf: swapping light and eye changes nothing, up to the square of the index") {
    Random random(4);
    for (const Case& c : rough_cases()) {
        Case other = c;
        other.inside = !c.inside;
        const Bsdf here = c.bsdf(), there = other.bsdf();
        std::size_t compared = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 wo = at_cosine(random.between(0.05F, 1), random.between(0, 6));
            Vec3 wi = random.direction();
            if (std::fabs(wi.z) < 0.05F) continue;
            const bool through = wi.z < 0;
            // Seen from the other side, z points there.
            const Vec3 wo2 = through ? -wi : wi, wi2 = through ? -wo : wo;
            const double forth = double{here.evaluate(wo, wi).value.y} / std::fabs(wi.z);
            double back = double{(through ? there : here).evaluate(wo2, wi2).value.y} / std::fabs(wi2.z);
            if (through && !c.thin) back /= c.behind();
            INFO(c.name() << (through ? " through" : " back"));
            if (std::fabs(forth - back) > 2e-3 * (forth + back) + 1e-6) CHECK(forth == back);
            compared += forth > 1e-3;
        }
        CHECK(compared > 100);
    }
}

TEST_CASE("bsdf: sampled weights are value over density, densities those of evaluation, and directions unit") {
    Random random(5);
    for (const Case& c : rough_cases()) {
        const Bsdf bsdf = c.bsdf();
        int wrong = 0, live = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3 wo = at_cosine(random.between(0.02F, 1), random.between(0, 6));
            const BsdfSample s = bsdf.sample(wo, {random.unit(), random.unit()});
            if (s.delta || !(max_component(s.weight) > 0)) continue;
            const BsdfValue f = bsdf.evaluate(wo, s.wi);
            ++live;
            wrong += !(f.pdf > 0) || std::fabs(s.pdf - f.pdf) > 1e-4F * f.pdf ||
                     std::fabs(s.weight.x * f.pdf - f.value.x) > 1e-4F * f.value.x ||
                     std::fabs(length(s.wi) - 1) > 1e-4F;
        }
        INFO(c.name());
        CHECK(wrong == 0);
        CHECK(live > 1000);
    }
}

TEST_CASE("bsdf: densities integrate to the share of samples that live, and samples follow them (chi-square)",
          "[slow]") {
    constexpr int bands = 16, sectors = 16, per_bin = 24, samples = 200000;
    for (const Case& c : rough_cases())
        for (const float cosine : {0.9F, 0.3F}) {
            const Bsdf bsdf = c.bsdf();
            const Vec3 wo = at_cosine(cosine);
            const auto bin = [&](Vec3 w) {
                const double turn = (std::atan2(w.y, w.x) + pi) / (2 * pi);
                const int band = std::clamp(static_cast<int>((w.z + 1) / 2 * bands), 0, bands - 1);
                return band * sectors + std::clamp(static_cast<int>(turn * sectors), 0, sectors - 1);
            };
            std::vector<double> expected(bands * sectors), found(bands * sectors);
            double total = 0;
            for (int b = 0; b < bands * per_bin; ++b)
                for (int s = 0; s < sectors * per_bin; ++s) {
                    const double z = -1 + 2 * (b + 0.5) / (bands * per_bin);
                    const double phi = -pi + 2 * pi * (s + 0.5) / (sectors * per_bin), r = std::sqrt(1 - z * z);
                    const Vec3 w{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                                 static_cast<float>(z)};
                    const double p = double{bsdf.evaluate(wo, w).pdf} * 4 * pi / (bands * per_bin * sectors * per_bin);
                    expected[static_cast<std::size_t>(b / per_bin * sectors + s / per_bin)] += p;
                    total += p;
                }
            Random random(6);
            int live = 0;
            for (int i = 0; i < samples; ++i) {
                const BsdfSample s = bsdf.sample(wo, {random.unit(), random.unit()});
                if (s.delta || !(max_component(s.weight) > 0)) continue;
                ++live;
                found[static_cast<std::size_t>(bin(s.wi))] += 1;
            }
            INFO(c.name() << " cosine " << cosine);
            CHECK(total == Approx(static_cast<double>(live) / samples).margin(0.01));
            double chi2 = 0;
            int cells = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const double e = expected[i] * samples;
                if (e < 20) continue;
                chi2 += (found[i] - e) * (found[i] - e) / e;
                ++cells;
            }
            // Five standard deviations, and a little for the integration of sharp lobes.
            CHECK(chi2 < 1.1 * cells + 5 * std::sqrt(2.0 * cells));
            CHECK(cells > 30);
        }
}

TEST_CASE("bsdf: visible normals: their density integrates to 1 for every roughness") {
    for (const float roughness : {0.5F, 0.7F, 1.0F})
        for (const float cosine : {1.0F, 0.5F, 0.1F}) {
            const Ggx ggx(roughness);
            const Vec3 wo = at_cosine(cosine);
            double sum = 0;
            constexpr int n = 400;
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < n; ++k) {
                    const double z = (i + 0.5) / n, phi = 2 * pi * (k + 0.5) / n, r = std::sqrt(1 - z * z);
                    sum += double{ggx.visible(wo, {static_cast<float>(r * std::cos(phi)),
                                                   static_cast<float>(r * std::sin(phi)), static_cast<float>(z)})};
                }
            INFO("roughness " << roughness << " cosine " << cosine);
            CHECK(sum * 2 * pi / (n * n) == Approx(1).epsilon(0.01));
        }
}

TEST_CASE("bsdf: Fresnel's equations: 4 per cent head on for glass, all beyond the critical angle, none for index 1") {
    float far = 0;
    CHECK(dielectric_fresnel(1, 1.5F, far) == Approx(0.04));
    CHECK(far == 1);
    CHECK(dielectric_fresnel(1, 1 / 1.5F, far) == Approx(0.04));
    CHECK(dielectric_fresnel(0.7F, 1 / 1.5F, far) == 1);  // critical angle: cosine 0.745
    CHECK(far == 0);
    CHECK(dielectric_fresnel(0.76F, 1 / 1.5F, far) < 1);
    CHECK(dielectric_fresnel(0.3F, 1, far) == 0);
    CHECK(far == 0.3F);
    // Brewster's angle, tan = 1.5: only half of the light can be reflected, by ((1 - n^2) / (1 + n^2))^2.
    const double r = (1 - 2.25) / (1 + 2.25);
    CHECK(dielectric_fresnel(static_cast<float>(1 / std::sqrt(1 + 2.25)), 1.5F, far) == Approx(0.5 * r * r));
    CHECK(dielectric_f0(1.5F) == Approx(0.04));
    CHECK(dielectric_f0(0) == 1);
}

TEST_CASE("bsdf: the tabulated albedo equals an integral over directions") {
    for (const float roughness : {0.4F, 0.55F, 0.77F, 1.0F})
        for (const float cosine : {0.95F, 0.6F, 0.3F, 0.1F}) {
            const Ggx ggx(roughness);
            const Vec3 wo = at_cosine(cosine);
            double white = 0, rise = 0;
            constexpr int n = 800;  // uniform in the square of the radius of the projected disc
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < n; ++k) {
                    const double z = (i + 0.5) / n, phi = 2 * pi * (k + 0.5) / n, r = std::sqrt(1 - z * z);
                    const Vec3 wi{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                                  static_cast<float>(z)};
                    const Vec3 h = normalize(wo + wi);
                    const double f = double{ggx.distribution(h) * ggx.masking_shadowing(wo, wi) / (4 * wo.z)};
                    white += f;
                    rise += f * double{schlick_rise(dot(wo, h))};
                }
            const double area = 2 * pi / (double{n} * n);
            const GgxAlbedo tabulated = ggx_albedo(cosine, roughness);
            INFO("roughness " << roughness << " cosine " << cosine);
            CHECK(tabulated.white() == Approx(white * area).margin(0.006));
            CHECK(tabulated.offset == Approx(rise * area).margin(0.006));
        }
}

TEST_CASE("bsdf: the sample coupling of glTF's appendix B reflects more than arrives, ours does not") {
    // f = (1 - F(wo.h)) / pi + coat, white, at a cosine of 0.05.
    const Vec3 wo = at_cosine(0.05F);
    double body = 0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const float z = std::sqrt((static_cast<float>(i) + 0.5F) / n);
            const Vec3 wi = at_cosine(z, 2 * std::numbers::pi_v<float> * (static_cast<float>(k) + 0.5F) / n);
            body += 1 - (0.04 + 0.96 * double{schlick_rise(dot(wo, normalize(wo + wi)))});
        }
    body /= n * n;
    CHECK(body + double{ggx_albedo(0.05F, 0.1F).of(0.04F)} > 1.5);
    CHECK(furnace({0, 0.1F}, wo) < 1.012);
}
