// The shape of everything that grows. It does not depend on detail: only the number and size of leaves do.
#pragma once

#include <array>
#include <vector>

#include "tracer/scene/builtin/courtyard/layout.hpp"
#include "tracer/scene/builtin/courtyard/materials.hpp"

namespace raycache::tracer::courtyard {

/// A limb of a tree: a bent curve through three points that tapers.
struct Branch {
    std::array<Vec3, 3> bend;  ///< start, control point, end
    float thick, thin;         ///< radii at start and end
    int level;                 ///< 0 = trunk, 4 = twig
    Vec3 wiggle;               ///< amplitude of a small sideways wave

    Vec3 at(float t) const;
};
inline constexpr int twig_level = 4;
std::vector<Branch> grow_tree(const TreeSite&, std::uint64_t stream);

/// A shoot of a climbing or hanging plant.
struct Shoot {
    std::vector<Vec3> path;
    std::vector<Vec3> outward;  ///< away from what it clings to, one per point
    float length;
    bool flowers;  ///< bougainvillea, or else ivy
};
std::vector<Shoot> grow_climbers();

struct PotSite {
    Vec3 at;
    float size;  ///< of the mouth, radius
    enum class Kind { classic, jar, bowl } kind;
    Stuff clay;
    enum class Plant { geranium, agave, shrub, fern } plant;

    float height() const { return size * (kind == Kind::jar ? 2.6F : kind == Kind::bowl ? 0.9F : 1.6F); }
};
std::vector<PotSite> pot_sites();

/// How many triangles of leaves go where; the sum of the shares is 1.
inline constexpr double tree_share = 0.62, climber_share = 0.22;
/// Adds leaves and petals of exactly or just under `triangles` triangles.
void foliage(MeshBuilder&, std::size_t triangles);
/// How many vertices foliage() adds.
std::size_t leaf_vertices(std::size_t triangles);

}  // namespace raycache::tracer::courtyard
