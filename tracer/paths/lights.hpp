// What a shadow ray can aim at: emissive triangles, punctual lights and the sun. The constant sky is met by bounce rays
// alone.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// A point on a light as seen from a surface.
struct LightSample {
    Vec3 direction;          ///< unit, towards the light
    float distance = 0;      ///< infinity for the sun and directional lights
    Vec3 normal;             ///< of the light's surface, on either side
    Vec3 radiance_over_pdf;  ///< radiance / (probability density per solid angle); black: not lit from here
    float pdf = 0;           ///< that density; infinity for a light of no size, which no other ray can meet
    float width = 0;         ///< of the light's triangle, its longest edge
    float off_origin = 0;  ///< |n.x p.x| + |n.y p.y| + |n.z p.z| of its normal and the point: what rounding grows with
    /// Of a triangle whose emission a texture says: still to be multiplied with its texel at (u, v). Else null.
    const Material* textured = nullptr;
    std::uint32_t triangle = 0;
    float u = 0, v = 0;
};

class Lights {
public:
    explicit Lights(const Scene&);  ///< which must outlive it

    bool empty() const { return !sun_ && cumulative_.empty(); }

    /// One light for the surface point `from`, by two numbers in [0, 1). Emissive triangles, which shine from both
    /// sides, and punctual lights are chosen by power; where there is a sun too, half of the samples go to it. The
    /// first number is used twice: what selection leaves of it is stretched to [0, 1) again.
    LightSample sample(Vec3 from, Vec2 random) const;

    /// The density with which sample() aims at a point of an emissive triangle that a ray of unit direction met at
    /// `distance`; `cosine` is between the two. 0 for triangles that send out nothing.
    float emitter_pdf(const Material&, std::uint32_t triangle, float distance, float cosine) const;

    /// The sun as rays meet it that leave the scene: a disc of constant radiance.
    struct SunDisc {
        Vec3 radiance;
        float pdf = 0;  ///< as in LightSample
    };
    /// Black outside the disc, and everywhere for a sun of no size.
    SunDisc sun_at(Vec3 direction) const;

private:
    struct Emitter {
        Vec3 corner, edge1, edge2;
        Vec3 normal;  ///< unit
        Vec3 radiance;
        float area, width;
        std::uint32_t triangle;
        const Material* textured;
    };
    void add_emitters(const Scene&, std::vector<double>& power);
    void add_punctual(const Scene&, std::vector<double>& power);
    LightSample sample_sun(Vec2 random) const;
    LightSample sample_emitter(Vec3 from, Vec2 random) const;
    LightSample sample_punctual(const PunctualLight&, float share, Vec3 from) const;

    std::vector<Emitter> emitters_;
    std::vector<PunctualLight> punctual_;
    std::vector<float> cumulative_;  ///< of power, emitters first, normalised; last is 1
    double power_ = 0;               ///< of all: the sum of area times luminance; punctual lights in that unit
    std::vector<std::pair<std::uint32_t, float>> textured_;  ///< triangle and mean luminance, by triangle
    bool sun_ = false;
    Sun sun_light_;
    float sun_sine2_ = 0;  ///< of the disc's radius
    float sun_pdf_ = std::numeric_limits<float>::infinity();
};

}  // namespace raycache::tracer
