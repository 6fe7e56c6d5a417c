// What a rasteriser leaves of a picture for passes over it: for each pixel how far away the surface at its centre is,
// and where it faces.
//
// A depth z, along the view, is stored as near / z, near being the least depth of the picture: 1 is nearest, 0 is the
// sky ("reversed" depth, whose numbers lie evenly in 1 / z as perspective does). In 4 bytes a float, in 2 a half; a
// surface is never rounded to the sky. Normals are those of the triangles, in the camera's frame, 4 bytes
// (pack_unit()).
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/bvh/embree_scene.hpp"
#include "tracer/paths/camera_rays.hpp"
#include "tracer/paths/packed_numbers.hpp"
#include "tracer/scene/scene.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

/// Where the number of a pixel lies.
enum class DepthLayout {
    linear,  ///< row after row
    tiled    ///< in tiles of 8 x 8 pixels, row after row of tiles, and of pixels in a tile; the last ones are filled up
};

struct DepthFormat {
    DepthLayout layout = DepthLayout::linear;
    std::uint32_t bytes = 4;  ///< of a depth: 2 or 4
    bool operator==(const DepthFormat&) const = default;
};

class DepthBuffer {
public:
    static constexpr std::uint32_t tile = 8;

    /// All sky, 1 to 16384 pixels on each axis; `near` above 0. Throws Error where the picture needs more memory than
    /// there is.
    DepthBuffer(std::uint32_t width, std::uint32_t height, DepthFormat, float near);

    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    float near() const { return near_; }
    std::uint32_t elements() const { return static_cast<std::uint32_t>(reciprocals_.size()); }

    /// Place of a pixel's number in memory, in numbers.
    std::uint32_t element(std::uint32_t x, std::uint32_t y) const {
        if (format_.layout == DepthLayout::linear) return y * width_ + x;
        return ((y / tile) * tiles_in_row_ + x / tile) * (tile * tile) + y % tile * tile + x % tile;
    }
    /// `depth`: at least near().
    void set(std::uint32_t element, float depth, Vec3 normal);

    /// near / z as stored; 0: sky.
    float reciprocal(std::uint32_t element) const { return reciprocals_[element]; }
    /// Unit, in the camera's frame. The pixel must not be sky.
    Vec3 normal(std::uint32_t element) const { return unpack_unit(normals_[element]); }
    /// By what share of itself the depth of such a stored number, above 0, may differ from the surface's.
    float error_of(float reciprocal) const {
        if (format_.bytes == 4) return 0x1p-23F;
        return 0x1p-11F + 0x1p-24F / reciprocal;
    }

    /// Depths (region 0) and normals (region 1), both in this layout; bases unset.
    std::vector<traces::Region> regions() const;

private:
    std::uint32_t width_, height_, tiles_in_row_;
    DepthFormat format_;
    float near_;
    std::vector<float> reciprocals_;
    std::vector<std::uint32_t> normals_;
};

/// By one ray through the centre of each pixel, on all threads of the current TBB arena; the result does not depend on
/// their number. Holes of alphaMode MASK are holes. A triangle without an area counts as sky.
DepthBuffer draw_depth(const Scene&, const CameraRays&, const EmbreeScene&, DepthFormat);

}  // namespace raycache::tracer
