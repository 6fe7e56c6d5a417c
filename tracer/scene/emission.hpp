// What emissive triangles send out, where a texture may say how much.
#pragma once

#include <cstdint>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// How much light the triangles of one material send out.
class MeanEmission {
public:
    /// Copies of texels under one triangle. Where there are more, the mean of the whole texture stands for theirs.
    static constexpr std::int64_t most_texels = std::int64_t{1} << 22;

    /// The scene must outlive it.
    MeanEmission(const Scene&, const Material&);

    /// Whether no triangle of this material can send out light.
    bool black() const { return !(whole_ > 0); }

    /// Luminance of the emission of a triangle of this material, its mean over the triangle's area: exactly 0 where
    /// every texel on it is black. May be called by several threads.
    float of(std::uint32_t triangle) const;

private:
    double texel(std::int64_t x, std::int64_t y) const;
    double over(const double (&x)[3], const double (&y)[3]) const;
    double at_points(const double (&x)[3], const double (&y)[3]) const;

    const Scene& scene_;
    const Material& material_;
    const Texture* texture_ = nullptr;
    double whole_ = 0;  ///< of the whole texture, or of the factor where there is none
};

/// False where the corners of a triangle lie in a line or a point, as far as float can tell.
bool has_area(const Scene&, std::size_t triangle);

/// Whether anything of the file sends out light: a triangle with area whose emission is not black, a punctual light.
bool emits_light(const Scene&);

}  // namespace raycache::tracer
