// What a shadow ray can aim at: emissive triangles and the sun. The constant sky is met by bounce rays alone.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// A point on a light as seen from a surface.
struct LightSample {
    Vec3 direction;          ///< unit, towards the light
    float distance = 0;      ///< infinity for the sun
    Vec3 radiance_over_pdf;  ///< radiance / (probability density per solid angle); black: not lit from here
};

class Lights {
public:
    explicit Lights(const Scene&);

    bool empty() const { return !sun_ && emitters_.empty(); }

    /// One light for the surface point `from`, by two numbers in [0, 1). Emissive triangles are chosen by power and
    /// shine from both sides; where there is a sun too, half of the samples go to it. The first number is used twice:
    /// what selection leaves of it is stretched to [0, 1) again.
    LightSample sample(Vec3 from, Vec2 random) const;

private:
    struct Emitter {
        Vec3 corner, edge1, edge2;
        Vec3 normal;  ///< unit
        Vec3 radiance;
        float area;
    };
    LightSample sample_sun(Vec2 random) const;
    LightSample sample_emitter(Vec3 from, Vec2 random) const;

    std::vector<Emitter> emitters_;
    std::vector<float> cumulative_;  ///< of power, normalised; last is 1
    bool sun_ = false;
    Sun sun_light_;
};

}  // namespace raycache::tracer
