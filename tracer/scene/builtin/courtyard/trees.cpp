// Trees: branches that divide towards points inside the crown, and their wood as tapered tubes.
#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/courtyard/plants.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

struct Crown {
    Vec3 middle, radii;

    /// `p`, moved inwards to the crown's surface if it lies outside.
    Vec3 clamp(Vec3 p) const {
        const Vec3 d = p - middle;
        const float r = length({d.x / radii.x, d.y / radii.y, d.z / radii.z});
        return r > 1 ? middle + d / r : p;
    }
};

constexpr std::array<int, 5> children{6, 5, 5, 5, 0};                 // of a branch, by its level
constexpr std::array<float, 5> reach{0, 0.62F, 0.42F, 0.24F, 0.15F};  // a branch's length in crown radii, by its level

void divide(std::vector<Branch>& tree, const Crown& crown, std::size_t parent_index, Random& random) {
    const Branch parent = tree[parent_index];
    const auto level = static_cast<std::size_t>(parent.level);
    for (int i = 0; i < children[level]; ++i) {
        Branch child;
        child.level = parent.level + 1;
        const float share = (static_cast<float>(i) + 1) / static_cast<float>(children[level]);
        const float t = parent.level == 0 ? 0.72F + 0.28F * share : 0.30F + 0.70F * share;
        const Vec3 start = parent.at(t);
        const Vec3 along = normalize(parent.bend[2] - parent.bend[1]);
        const Vec3 away = normalize(start - crown.middle);
        Vec3 heading;
        if (parent.level == 0) {  // limbs: spread like the fingers of a hand
            const auto [c, s] = cos_sin(static_cast<double>(i) * 0.382 + static_cast<double>(random.in(-0.05F, 0.05F)));
            heading = {c, 0.45F + 0.9F * share * random.in(0.7F, 1.1F), -s};
        } else {
            heading = along * 0.55F + away * 0.35F + random.jitter(0.9F) + Vec3{0, 0.12F, 0};
        }
        const float size = reach[level + 1] * (crown.radii.x + crown.radii.y) / 2 * random.in(0.75F, 1.25F);
        const Vec3 end = crown.clamp(start + normalize(heading) * size);
        const Vec3 middle = (start + end) / 2 + along * (0.18F * size) + random.jitter(0.08F * size);
        child.bend = {start, middle, end};
        child.thick = (parent.thick + (parent.thin - parent.thick) * t) * (parent.level == 0 ? 0.62F : 0.66F);
        child.thin = child.thick * 0.5F;
        child.wiggle = random.jitter(0.025F * size);
        tree.push_back(child);
        divide(tree, crown, tree.size() - 1, random);
    }
}

}  // namespace

Vec3 Branch::at(float t) const {
    const float s = 1 - t;
    const float wave = cos_sin(static_cast<double>(1.5F * t)).sin * 4 * t * s;
    return bend[0] * (s * s) + bend[1] * (2 * s * t) + bend[2] * (t * t) + wiggle * wave;
}

std::vector<Branch> grow_tree(const TreeSite& site, std::uint64_t stream) {
    Random random(stream);
    const float below = 0.34F * site.height;  // the crown starts here
    const Crown crown{site.at + Vec3{0, (site.height + below) / 2, 0},
                      {site.spread, (site.height - below) / 2, site.spread}};
    Branch trunk;
    const Vec3 lean = random.jitter(0.16F) * Vec3{1, 0, 1};
    trunk.bend = {site.at, site.at + lean + Vec3{0, 0.25F * site.height, 0},
                  site.at + lean * -1.2F + Vec3{0, 0.50F * site.height, 0}};
    trunk.thick = 0.030F * site.height;
    trunk.thin = 0.020F * site.height;
    trunk.level = 0;
    trunk.wiggle = random.jitter(0.06F) * Vec3{1, 0, 1};
    std::vector<Branch> tree{trunk};
    divide(tree, crown, 0, random);
    return tree;
}

void tree_wood(MeshBuilder& b, Fineness fine) {
    constexpr std::array<double, 5> around{11, 7, 5, 3.4, 2.6}, pieces{7, 5, 3.5, 2.2, 1.2};
    const int deepest = fine.value < 0.45 ? 2 : fine.value < 0.75 ? 3 : twig_level;
    std::uint64_t stream = 71;
    for (const TreeSite& site : tree_sites) {
        b.use(Stuff::bark);
        for (const Branch& branch : grow_tree(site, stream++)) {
            if (branch.level > deepest) continue;
            const auto level = static_cast<std::size_t>(branch.level);
            const int n = fine.of(pieces[level], level == 0 ? 3 : level < 3 ? 2 : 1);
            std::vector<Vec3> path;
            std::vector<float> radii;
            for (int i = 0; i <= n; ++i) {
                const float t = static_cast<float>(i) / static_cast<float>(n);
                const float foot = branch.level == 0 ? 0.55F * std::max(0.F, 1 - 6 * t) : 0;
                path.push_back(branch.at(t));
                radii.push_back((branch.thick + (branch.thin - branch.thick) * t) * (1 + foot));
            }
            tube(b, path, radii, fine.of(around[level], level == 0 ? 5 : 3));
        }
        // A ring of stone to sit on, with earth inside.
        const float r = site.planter;
        const std::array<Turning, 9> wall{{{r, -0.05F, true},
                                           {r, 0.36F, true},
                                           {r + 0.05F, 0.37F, true},
                                           {r + 0.065F, 0.40F},
                                           {r + 0.05F, 0.43F, true},
                                           {r - 0.22F, 0.43F, true},
                                           {r - 0.235F, 0.40F},
                                           {r - 0.22F, 0.37F, true},
                                           {r - 0.22F, 0.2F, true}}};
        b.frame(moved(site.at));
        b.use(Stuff::white_plaster);
        const auto at = [&](float u, float v) {
            const auto [c, s] = cos_sin(static_cast<double>(u));
            return Vec3{r * c, -0.05F + 0.42F * v, -r * s};
        };
        sheet(b, fine.of(30, 10), 1, at, {2.5F * r, 0.17F});
        b.use(Stuff::pale_stone);
        lathe(b, curve(std::span(wall).subspan(1), fine.of(2, 1)), fine.of(30, 10));
        b.use(Stuff::soil);
        disc(b, {0, 0.31F, 0}, r - 0.21F, fine.of(30, 10));
        b.frame({});
    }
    b.use(Stuff::bark);
    for (const Shoot& shoot : grow_climbers()) {
        if (shoot.flowers || fine.value < 0.4) continue;
        const std::size_t step = fine.value < 1 ? 2 : 1;
        std::vector<Vec3> path;
        for (std::size_t i = 0; i < shoot.path.size(); i += step) path.push_back(shoot.path[i]);
        if (path.size() > 1) tube(b, path, 0.009F, fine.of(4, 3));
    }
}

}  // namespace raycache::tracer::courtyard
