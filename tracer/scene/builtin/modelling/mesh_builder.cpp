#include "tracer/scene/builtin/modelling/mesh_builder.hpp"

#include <utility>

#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::modelling {

Transform moved(Vec3 to) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, to}; }

Transform turned(double turns) {
    const auto [c, s] = cos_sin(turns);
    return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}, {0, 0, 0}};
}

Transform scaled(Vec3 by) { return {{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {0, 0, 0}}; }

Transform aligned(Vec3 up, double turns, Vec3 origin) {
    const Vec3 y = normalize(up);
    const Vec3 other = std::abs(y.y) < 0.9F ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 a = normalize(cross(other, y)), b = cross(a, y);  // a, y, b left-handed: a x y = b
    const auto [c, s] = cos_sin(turns);
    const Vec3 x = a * c + b * s;
    return {x, y, cross(x, y), origin};
}

MeshBuilder MeshBuilder::counter() {
    MeshBuilder b;
    b.counting_ = true;
    return b;
}

MeshBuilder MeshBuilder::part() const { return counting_ ? counter() : MeshBuilder(); }

void MeshBuilder::reserve(std::size_t vertices, std::size_t triangles) {
    positions_.reserve(vertices);
    normals_.reserve(vertices);
    texcoords_.reserve(vertices);
    indices_.reserve(3 * triangles);
    material_of_.reserve(triangles);
}

std::uint32_t MeshBuilder::vertex(Vec3 position, Vec3 normal, Vec2 texcoord) {
    if (!counting_) {
        positions_.push_back(frame_.point(position));
        normals_.push_back(frame_.normal(normal));
        texcoords_.push_back(texcoord);
    }
    return static_cast<std::uint32_t>(vertices_++);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    ++triangles_;
    if (counting_) return;
    indices_.insert(indices_.end(), {a, b, c});
    material_of_.push_back(material_.value);
}

void MeshBuilder::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
}

void MeshBuilder::copy_geometry(const MeshBuilder& part, const Transform& where) {
    if (!counting_) {
        const Transform all = frame_ * where;
        const auto first = static_cast<std::uint32_t>(vertices_);
        for (const Vec3 p : part.positions_) positions_.push_back(all.point(p));
        for (const Vec3 n : part.normals_) normals_.push_back(n == Vec3{} ? n : all.normal(n));
        texcoords_.insert(texcoords_.end(), part.texcoords_.begin(), part.texcoords_.end());
        for (const std::uint32_t i : part.indices_) indices_.push_back(first + i);
    }
    vertices_ += part.vertices_;
    triangles_ += part.triangles_;
}

void MeshBuilder::add(const MeshBuilder& part, const Transform& where) {
    copy_geometry(part, where);
    if (!counting_) material_of_.insert(material_of_.end(), part.material_of_.begin(), part.material_of_.end());
}

void MeshBuilder::add(const MeshBuilder& part, const Transform& where, MaterialIndex material) {
    copy_geometry(part, where);
    if (!counting_) material_of_.insert(material_of_.end(), part.triangles_, material.value);
}

void MeshBuilder::count(std::size_t vertices, std::size_t triangles) {
    vertices_ += vertices;
    triangles_ += triangles;
}

void MeshBuilder::move_into(Scene& scene) && {
    scene.positions = std::move(positions_);
    scene.normals = std::move(normals_);
    scene.texcoords = std::move(texcoords_);
    scene.indices = std::move(indices_);
    scene.material_of = std::move(material_of_);
}

}  // namespace raycache::tracer::modelling
