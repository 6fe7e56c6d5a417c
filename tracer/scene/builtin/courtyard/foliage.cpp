// Leaves: as many as the triangles left allow, each as large as that number asks for, so that the crowns cover about
// the same area at every detail.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/courtyard/plants.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

/// Finer leaves where there is room for many.
int leaf_segments(std::size_t triangles) {
    return triangles < 60'000 ? 1 : triangles < 400'000 ? 2 : triangles < 2'500'000 ? 3 : 4;
}
std::size_t leaf_triangles(int segments) { return segments == 1 ? 2 : 4 * (static_cast<std::size_t>(segments) - 1); }

enum Shape { oval, heart, blade };

/// Of unit length along +Z, upper side +Y: folded along the midrib and bent down towards the tip. `segments` along the
/// midrib: 1 gives 2 triangles, n gives 4 (n - 1).
MeshBuilder leaf(Shape shape, int segments) {
    // Half the width at the base, the middle and so on: a curve through five points.
    constexpr std::array<std::array<float, 5>, 3> widths{
        {{0, 0.21F, 0.24F, 0.17F, 0}, {0, 0.46F, 0.38F, 0.20F, 0}, {0, 0.085F, 0.085F, 0.055F, 0}}};
    const auto half_width = [&](float t) {
        const auto i = std::min(static_cast<std::size_t>(4 * t), std::size_t{3});
        const float f = 4 * t - static_cast<float>(i);
        return widths[shape][i] + (widths[shape][i + 1] - widths[shape][i]) * f;
    };
    const float bend = shape == blade ? 0.30F : 0.22F;
    const auto edge = [&](float t, float side) {
        const float w = half_width(t), back = shape == heart ? 0.14F * (1 - t) : 0;
        return Vec3{side * w, 0.35F * w - bend * t * t, t - back};
    };
    MeshBuilder b;
    const auto base = b.vertex({0, 0, 0});
    if (segments == 1) {
        const auto right = b.vertex(edge(0.42F, 1)), left = b.vertex(edge(0.42F, -1)), tip = b.vertex({0, -bend, 1});
        b.triangle(base, left, tip);
        b.triangle(base, tip, right);
        return b;
    }
    std::uint32_t rib = base, left = base, right = base;
    for (int i = 1; i < segments; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(segments);
        const auto next_rib = b.vertex({0, -bend * t * t, t});
        const auto next_left = b.vertex(edge(t, -1)), next_right = b.vertex(edge(t, 1));
        if (i == 1) {
            b.triangle(base, next_left, next_rib);
            b.triangle(base, next_rib, next_right);
        } else {
            b.quad(rib, left, next_left, next_rib);
            b.quad(rib, next_rib, next_right, right);
        }
        rib = next_rib, left = next_left, right = next_right;
    }
    const auto tip = b.vertex({0, -bend, 1});
    b.triangle(rib, left, tip);
    b.triangle(rib, tip, right);
    return b;
}

/// Leaf at `at`, growing along `heading`, upper side towards `up`.
Transform place(Vec3 at, Vec3 heading, Vec3 up, float size) {
    const Vec3 z = normalize(heading);
    Vec3 x = normalize(cross(up, z));
    if (x == Vec3{}) x = {1, 0, 0};
    return {x * size, cross(z, x) * size, z * size, at};
}

/// Length of `count` leaves that cover `area` together.
float leaf_size(float area, std::size_t count, float least, float most) {
    const float one = area / static_cast<float>(std::max<std::size_t>(count, 1));
    return std::min(most, std::max(least, std::sqrt(one / 0.28F)));
}

void tree_leaves(MeshBuilder& b, std::size_t count, int segments) {
    const MeshBuilder blade_of_tree = leaf(oval, segments);
    constexpr std::array<std::array<Stuff, 3>, 4> greens{{{Stuff::leaf_deep, Stuff::leaf_mid, Stuff::leaf_light},
                                                          {Stuff::leaf_mid, Stuff::leaf_light, Stuff::leaf_deep},
                                                          {Stuff::leaf_olive, Stuff::leaf_mid, Stuff::leaf_olive},
                                                          {Stuff::leaf_light, Stuff::leaf_mid, Stuff::leaf_mid}}};
    float crowns = 0;
    for (const TreeSite& site : tree_sites) crowns += site.spread * site.height;
    std::size_t given = 0;
    for (std::size_t k = 0; k < tree_sites.size(); ++k) {
        const TreeSite& site = tree_sites[k];
        const auto part = static_cast<std::size_t>(static_cast<double>(count) *
                                                   static_cast<double>(site.spread * site.height / crowns));
        const std::size_t leaves = k + 1 == tree_sites.size() ? count - given : part;
        given += leaves;
        std::vector<Branch> twigs;
        for (const Branch& branch : grow_tree(site, 71 + k)) {
            if (branch.level >= twig_level - 1) twigs.push_back(branch);
        }
        const float size = leaf_size(4.4F * site.spread * site.height, leaves, 0.045F, 0.36F);
        Random random(111 + k);
        for (std::size_t i = 0; i < leaves; ++i) {
            const Branch& twig = twigs[random.below(static_cast<std::uint32_t>(twigs.size()))];
            const float t = random.in(0.15F, 1.0F);
            const Vec3 at = twig.at(t) + random.jitter(0.05F * site.spread);
            const Vec3 heading =
                normalize(twig.bend[2] - twig.bend[0]) * 0.6F + random.jitter(0.9F) + Vec3{0, -0.25F, 0};
            const Vec3 up = Vec3{0, 1, 0} + random.jitter(0.6F);
            const float grown = size * random.in(0.7F, 1.25F);
            const std::uint32_t colour = random.below(10);
            b.add(blade_of_tree, place(at, heading, up, grown), greens[k][colour < 6 ? 0 : colour < 9 ? 1 : 2]);
        }
    }
}

void climber_leaves(MeshBuilder& b, std::size_t count, int segments) {
    const MeshBuilder ivy = leaf(heart, segments), petal = leaf(oval, segments);
    const std::vector<Shoot> shoots = grow_climbers();
    float total = 0;
    for (const Shoot& shoot : shoots) total += shoot.length;
    const float size = leaf_size(70, count, 0.035F, 0.22F);
    Random random(121);
    float sum = 0;
    std::size_t given = 0;
    for (const Shoot& shoot : shoots) {
        sum += shoot.length;
        const auto until =
            &shoot == &shoots.back()
                ? count
                : static_cast<std::size_t>(static_cast<double>(count) * static_cast<double>(sum / total));
        for (; given < until; ++given) {
            const float along = random.unit() * static_cast<float>(shoot.path.size() - 1);
            const auto i = std::min(static_cast<std::size_t>(along), shoot.path.size() - 2);
            const float f = along - static_cast<float>(i);
            const Vec3 stem = shoot.path[i] + (shoot.path[i + 1] - shoot.path[i]) * f;
            const Vec3 out = shoot.outward[i];
            const bool flower = shoot.flowers && random.below(20) < 13;
            const Vec3 aside = random.jitter(0.09F);
            const Vec3 at = stem + aside + out * random.in(0.0F, 0.05F);
            const Vec3 down{0, shoot.flowers ? -0.3F : -0.8F, 0};
            const Vec3 heading = down + random.jitter(0.8F) + out * 0.5F;
            const Vec3 up = out + random.jitter(0.45F) + Vec3{0, 0.3F, 0};
            const float grown = size * random.in(0.7F, 1.2F) * (shoot.flowers ? 1 : 0.95F);
            const bool light = random.below(3) == 0;
            const Stuff stuff = flower ? Stuff::bougainvillea : light ? Stuff::ivy_light : Stuff::ivy_dark;
            b.add(shoot.flowers ? petal : ivy, place(at, heading, up, grown), stuff);
        }
    }
}

/// One leaf or petal of a plant whose foot is at the origin; `s` is the pot's size.
struct Growth {
    Transform where;
    Stuff stuff;
    Shape shape;
};

Growth potted(PotSite::Plant plant, float s, float size, Random& random) {
    using Plant = PotSite::Plant;
    const auto [c, sine] = cos_sin(static_cast<double>(random.unit()));
    const Vec3 outwards{c, 0, -sine};
    const float r = random.unit();
    if (plant == Plant::agave || plant == Plant::fern) {  // long blades from the middle
        const bool fern = plant == Plant::fern;
        const float steep = fern ? random.in(0.7F, 2.4F) : random.in(0.25F, 2.2F);
        const float long_ = s * (fern ? random.in(1.7F, 3.0F) : random.in(1.8F, 2.6F));
        Transform t =
            place(outwards * (0.15F * s), outwards + Vec3{0, steep, 0}, Vec3{0, 1, 0} - outwards * 0.4F, long_);
        const float wide = fern ? 0.5F : 1.15F;
        t.x = t.x * wide;
        return {t, fern ? Stuff::leaf_light : Stuff::agave, blade};
    }
    const bool shrub = plant == Plant::shrub;
    const float height = s * (shrub ? 3.2F : 1.5F), y = height * random.unit();
    const float bush =
        s * (shrub ? 1.25F : 1.35F) * std::sqrt(std::max(0.05F, 1 - (2 * y / height - 1) * (2 * y / height - 1)));
    const Vec3 at = outwards * (bush * std::sqrt(r)) + Vec3{0, y, 0};
    const bool flower = !shrub && y > 0.45F * height && random.below(3) == 0;
    const Vec3 up = Vec3{0, 1, 0} + outwards * 0.5F + random.jitter(0.5F);
    const Stuff green = random.below(3) == 0 ? Stuff::leaf_light : Stuff::leaf_mid;
    const Vec3 heading = outwards + random.jitter(0.7F);
    const float grown = size * random.in(0.7F, 1.2F);
    const Stuff stuff = flower ? Stuff::geranium : shrub ? Stuff::leaf_deep : green;
    return {place(at, heading, up, grown), stuff, shrub ? oval : heart};
}

void potted_leaves(MeshBuilder& b, std::size_t count, int segments) {
    const std::array<MeshBuilder, 3> shapes{leaf(oval, segments), leaf(heart, segments), leaf(blade, segments)};
    const std::vector<PotSite> sites = pot_sites();
    // A blade is as long as its plant, whatever the detail, so there is an end to how many a plant can have.
    const auto blades = [&](const PotSite& site) -> std::size_t {
        const bool agave = site.plant == PotSite::Plant::agave, fern = site.plant == PotSite::Plant::fern;
        return std::min<std::size_t>(count / sites.size(), agave ? 45 : fern ? 140 : 0);
    };
    std::size_t bushes = 0, for_bushes = count;
    for (const PotSite& site : sites) {
        for_bushes -= blades(site);
        bushes += blades(site) == 0 ? 1 : 0;
    }
    const float size = leaf_size(24, for_bushes, 0.025F, 0.22F);
    Random random(131);
    std::size_t bush = 0;
    for (const PotSite& site : sites) {
        std::size_t leaves = blades(site);
        if (leaves == 0) {
            leaves = for_bushes * (bush + 1) / bushes - for_bushes * bush / bushes;
            ++bush;
        }
        const Transform foot = moved(site.at + Vec3{0, site.height() - 0.13F * site.size, 0});
        for (std::size_t i = 0; i < leaves; ++i) {
            const Growth g = potted(site.plant, site.size, size, random);
            b.add(shapes[g.shape], foot * g.where, g.stuff);
        }
    }
}

}  // namespace

std::size_t leaf_vertices(std::size_t triangles) {
    const int segments = leaf_segments(triangles);
    return triangles / leaf_triangles(segments) * static_cast<std::size_t>(segments == 1 ? 4 : 3 * segments - 1);
}

void foliage(MeshBuilder& b, std::size_t triangles) {
    const int segments = leaf_segments(triangles);
    const std::size_t leaves = triangles / leaf_triangles(segments);
    const auto trees = static_cast<std::size_t>(static_cast<double>(leaves) * tree_share);
    const auto climbers = static_cast<std::size_t>(static_cast<double>(leaves) * climber_share);
    tree_leaves(b, trees, segments);
    climber_leaves(b, climbers, segments);
    potted_leaves(b, leaves - trees - climbers, segments);
}

}  // namespace raycache::tracer::courtyard
