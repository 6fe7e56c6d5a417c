#include "tracer/scene/gltf_transform.hpp"

#include <cmath>

namespace raycache::tracer {

Vec3 Transform::point(Vec3 p) const {
    const auto row = [&](const std::array<double, 4>& r) {
        return static_cast<float>(r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]);
    };
    return {row(rows[0]), row(rows[1]), row(rows[2])};
}

Vec3d Transform::exact_point(Vec3d p) const {
    const auto row = [&](const std::array<double, 4>& r) { return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]; };
    return {row(rows[0]), row(rows[1]), row(rows[2])};
}

double Transform::determinant() const {
    return rows[0][0] * (rows[1][1] * rows[2][2] - rows[1][2] * rows[2][1]) -
           rows[0][1] * (rows[1][0] * rows[2][2] - rows[1][2] * rows[2][0]) +
           rows[0][2] * (rows[1][0] * rows[2][1] - rows[1][1] * rows[2][0]);
}

Transform operator*(const Transform& parent, const Transform& child) {
    Transform result;
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 4; ++c) {
            double sum = c == 3 ? parent.rows[r][3] : 0;
            for (std::size_t k = 0; k < 3; ++k) sum += parent.rows[r][k] * child.rows[k][c];
            result.rows[r][c] = sum;
        }
    }
    return result;
}

Transform transform_from_matrix(const std::vector<double>& m) {
    Transform result;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) result.rows[r][c] = m[c * 4 + r];
    return result;
}

Transform transform_from_trs(const std::vector<double>& translation, const std::vector<double>& rotation,
                             const std::vector<double>& scale) {
    Transform result;
    if (!rotation.empty()) {
        const double norm = std::sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1] +
                                      rotation[2] * rotation[2] + rotation[3] * rotation[3]);
        const double x = rotation[0] / norm, y = rotation[1] / norm, z = rotation[2] / norm, w = rotation[3] / norm;
        result.rows = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
                        {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
                        {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
    }
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3 && !scale.empty(); ++c) result.rows[r][c] *= scale[c];
        if (!translation.empty()) result.rows[r][3] = translation[r];
    }
    return result;
}

NormalTransform::NormalTransform(const Transform& t) {
    // The cofactor matrix is the inverse transpose times the determinant; only the sign of the latter matters.
    const double sign = t.determinant() < 0 ? -1 : 1;
    for (std::size_t r = 0; r < 3; ++r) {
        const auto& a = t.rows[(r + 1) % 3];
        const auto& b = t.rows[(r + 2) % 3];
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            rows_[r][c] = sign * (a[c1] * b[c2] - a[c2] * b[c1]);
        }
    }
}

Vec3 NormalTransform::operator()(Vec3 n) const {
    std::array<double, 3> v{};
    for (std::size_t r = 0; r < 3; ++r) v[r] = rows_[r][0] * n.x + rows_[r][1] * n.y + rows_[r][2] * n.z;
    const double norm = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(norm > 0) || !std::isfinite(norm)) return {0, 0, 0};
    return {static_cast<float>(v[0] / norm), static_cast<float>(v[1] / norm), static_cast<float>(v[2] / norm)};
}

}  // namespace raycache::tracer
