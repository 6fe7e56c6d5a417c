// Collects triangles. The same code that builds a part also counts it: a counting builder keeps numbers, not vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer::modelling {

/// An affine map that keeps handedness: columns x, y, z and an origin.
struct Transform {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};

    Vec3 direction(Vec3 d) const { return x * d.x + y * d.y + z * d.z; }
    Vec3 point(Vec3 p) const { return direction(p) + origin; }
    /// A unit normal stays a unit normal; (0, 0, 0), which asks for face normals, stays (0, 0, 0).
    Vec3 normal(Vec3 n) const { return normalize(cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z); }
    /// First `inner`, then this.
    Transform operator*(const Transform& inner) const {
        return {direction(inner.x), direction(inner.y), direction(inner.z), point(inner.origin)};
    }
};

Transform moved(Vec3 to);
/// About Y; a quarter turn takes +Z to +X.
Transform turned(double turns);
Transform scaled(Vec3 by);
/// +Y goes to `up` (any length but zero), the other axes to some frame around it, turned about it by `turns`.
Transform aligned(Vec3 up, double turns, Vec3 origin);

/// An index into Scene::materials; a scene names its own by an enumeration.
struct MaterialIndex {
    std::uint16_t value;

    template <class Name>
    requires std::is_enum_v<Name> MaterialIndex(Name name) : value(static_cast<std::uint16_t>(name)) {}
    explicit MaterialIndex(std::uint16_t v) : value(v) {}
};

class MeshBuilder {
public:
    /// A builder that only counts.
    static MeshBuilder counter();
    /// An empty builder of this one's kind, for a prototype that add() places many times.
    MeshBuilder part() const;

    bool counting() const { return counting_; }
    std::size_t triangles() const { return triangles_; }
    std::size_t vertices() const { return vertices_; }
    void reserve(std::size_t vertices, std::size_t triangles);

    /// Material of later triangles.
    void use(MaterialIndex material) { material_ = material; }
    /// Where later vertices and parts go.
    void frame(const Transform& frame) { frame_ = frame; }
    const Transform& frame() const { return frame_; }

    std::uint32_t vertex(Vec3 position, Vec3 normal = {}, Vec2 texcoord = {});
    /// Counter-clockwise from the front.
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

    /// A copy of `part`, in its own materials.
    void add(const MeshBuilder& part, const Transform& where);
    /// A copy of `part`, all in one material.
    void add(const MeshBuilder& part, const Transform& where, MaterialIndex material);
    /// `vertices` and `triangles` that would have come; for counting builders only.
    void count(std::size_t vertices, std::size_t triangles);

    /// Moves the geometry into `scene`.
    void move_into(Scene& scene) &&;

private:
    bool counting_ = false;
    std::size_t vertices_ = 0, triangles_ = 0;
    MaterialIndex material_{0};
    Transform frame_;
    std::vector<Vec3> positions_, normals_;
    std::vector<Vec2> texcoords_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::uint16_t> material_of_;

    void copy_geometry(const MeshBuilder& part, const Transform& where);
};

}  // namespace raycache::tracer::modelling
