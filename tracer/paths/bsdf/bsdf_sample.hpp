// What a BSDF answers. Directions are unit, in a frame whose z axis is the shading normal on the side the ray came
// from; `wo` points back along the ray (z > 0), `wi` on to where light comes from (z < 0: on the other side).
#pragma once

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// Of a pair of directions.
struct BsdfValue {
    Vec3 value;     ///< f(wo, wi) |cos(wi)|, without delta lobes
    float pdf = 0;  ///< density per solid angle with which sample() chooses wi; delta lobes not counted

    BsdfValue& operator+=(const BsdfValue& other) {
        value += other.value;
        pdf += other.pdf;
        return *this;
    }
};
inline BsdfValue operator*(const BsdfValue& b, float share) { return {b.value * share, b.pdf * share}; }

/// A direction chosen at random.
struct BsdfSample {
    Vec3 wi;
    Vec3 weight;            ///< f |cos| / probability of the choice; black: nothing comes from there, the path ends
    float pdf = 0;          ///< as BsdfValue's of the same pair; unused where `delta`
    bool delta = false;     ///< one of countably many directions: no light sample can find it
    bool straight = false;  ///< alpha: nothing is there; `wi` is -wo
};

/// Takes one of two with probability `first` and stretches what the choice leaves of `random` to [0, 1) again.
inline bool choose(float first, float& random) {
    const bool taken = random < first;
    random = taken ? random / first : (random - first) / (1 - first);
    random = random < 0x1.fffffep-1F ? random : 0x1.fffffep-1F;
    return taken;
}

}  // namespace raycache::tracer
