// Affine maps of glTF nodes, in double so that a deep hierarchy costs no precision.
#pragma once

#include <array>
#include <vector>

#include "tracer/scene/scene_frame.hpp"
#include "tracer/vec.hpp"

namespace raycache::tracer {

struct Transform {
    /// Three rows of four: linear part and translation. Identity to begin with.
    std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

    Vec3 point(Vec3) const;
    Vec3d exact_point(Vec3d) const;
    double determinant() const;
};

/// First `child`, then `parent`.
Transform operator*(const Transform& parent, const Transform& child);

/// 16 numbers in column-major order; the last row is taken to be 0 0 0 1.
Transform transform_from_matrix(const std::vector<double>&);

/// Scale, then rotation (quaternion x y z w of any non-zero length), then translation; an empty vector is the identity.
Transform transform_from_trs(const std::vector<double>& translation, const std::vector<double>& rotation,
                             const std::vector<double>& scale);

/// Maps normals by the inverse transpose, up to length. Works for singular maps too.
class NormalTransform {
public:
    explicit NormalTransform(const Transform&);
    /// Unit, or (0,0,0) where the result has no direction or is not finite.
    Vec3 operator()(Vec3 normal) const;

private:
    std::array<std::array<double, 3>, 3> rows_;
};

}  // namespace raycache::tracer
