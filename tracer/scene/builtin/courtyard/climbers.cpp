// Ivy that winds up columns and spreads over the wall above; bougainvillea that falls over the gallery's railing.
#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/courtyard/plants.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

struct Ivy {
    int side, column;  ///< of sides(); where it has its root
    int shoots;
    float spread;  ///< how far it goes along the wall
};
constexpr std::array<Ivy, 7> ivies{{{1, 1, 11, 1.5F},
                                    {1, 3, 8, 1.2F},
                                    {2, 0, 12, 1.9F},
                                    {2, 2, 12, 1.7F},
                                    {2, 5, 9, 1.3F},
                                    {3, 2, 9, 1.3F},
                                    {0, 4, 9, 1.4F}}};

struct Fall {
    int side, bay;
    int shoots;
    float longest;
};
constexpr std::array<Fall, 6> falls{
    {{1, 1, 46, 1.8F}, {1, 2, 34, 1.2F}, {2, 0, 46, 1.7F}, {2, 3, 34, 1.3F}, {3, 1, 34, 1.4F}, {0, 2, 34, 1.4F}}};

float length_of(const std::vector<Vec3>& path) {
    float sum = 0;
    for (std::size_t i = 1; i < path.size(); ++i) sum += length(path[i] - path[i - 1]);
    return sum;
}

/// In a wing's frame, root at the foot of a column on the yard's side.
Shoot ivy(const Side& side, const Ivy& plant, Random& random) {
    Shoot shoot;
    shoot.flowers = false;
    const float axis = side.column(plant.column), radius = plant.column == 0 ? 0.37F : 0.21F;
    // Up the column, winding about its yard side.
    const float turn_from = random.in(-0.22F, 0.22F), turn_to = random.in(-0.22F, 0.22F);
    const float top = random.in(0.75F, 1.0F) * (spring - arcade_floor);
    constexpr int steps = 14;
    for (int i = 0; i <= steps; ++i) {
        const float t = static_cast<float>(i) / steps, y = arcade_floor + top * t;
        const auto [c, s] = cos_sin(static_cast<double>(turn_from + (turn_to - turn_from) * t));
        const float foot = y < 0.6F || y > spring - 0.45F ? 0.13F : 0.01F;
        const Vec3 out{s, 0, -c};
        shoot.path.push_back(Vec3{axis, y, 0} + out * (radius + foot) + random.jitter(0.02F));
        shoot.outward.push_back(out);
    }
    // Over the wall, round the arch, and along the cornice.
    float x = shoot.path.back().x, y = shoot.path.back().y;
    float drift = random.in(-1, 1);
    const float reach = random.in(0.4F, 1.0F) * plant.spread;
    const float r = side.pitch() / 2 - impost;
    for (int i = 0; i < 22 && std::abs(x - axis) < reach && y < gallery_floor + 0.9F; ++i) {
        drift += random.in(-0.35F, 0.35F) - 0.05F * drift;
        y += random.in(0.05F, 0.16F) * std::max(0.25F, 1 - 0.5F * std::abs(drift));
        x += 0.13F * drift;
        const float middle = axis + (x < axis ? -0.5F : 0.5F) * side.pitch(), from_middle = x - middle;
        if (std::abs(from_middle) < r) {  // keep above the arch
            y = std::max(y, spring + std::sqrt(r * r - from_middle * from_middle) + 0.06F);
        }
        const float z = y > slab_bottom ? (y > gallery_floor ? -0.10F : -arch_wall - 0.24F) : -arch_wall - 0.08F;
        shoot.path.push_back(Vec3{x, y, z} + random.jitter(0.025F));
        shoot.outward.push_back({0, 0, -1});
    }
    return shoot;
}

Shoot fall(const Side& side, const Fall& plant, Random& random) {
    Shoot shoot;
    shoot.flowers = true;
    const float middle = side.column(plant.bay) + side.pitch() / 2;
    const float off = random.in(-1, 1), x = middle + off * (side.pitch() / 2 + 0.25F);
    const float drop = plant.longest * random.in(0.35F, 1.0F) * (1.1F - 0.7F * off * off);
    const float bulge = random.in(0.12F, 0.42F), sway = random.in(-0.25F, 0.25F), crest = random.in(0.0F, 0.32F);
    constexpr int steps = 12;
    for (int i = 0; i <= steps; ++i) {
        const float t = static_cast<float>(i) / steps;
        const float y = gallery_floor + 0.95F + crest * 4 * t * (0.5F - t) * 2 - drop * t * t - 0.25F * t;
        const float z = 0.15F - (0.3F + 0.25F + bulge) * (1 - (1 - t) * (1 - t));
        shoot.path.push_back(Vec3{x + sway * t, y, z} + random.jitter(0.03F));
        shoot.outward.push_back(normalize(Vec3{0.3F * sway, 0.4F, -1}));
    }
    return shoot;
}

}  // namespace

std::vector<Shoot> grow_climbers() {
    Random random(81);
    std::vector<Shoot> shoots;
    const auto all = sides();
    const auto place = [&](Shoot shoot, const Side& side) {
        for (Vec3& p : shoot.path) p = side.frame.point(p);
        for (Vec3& n : shoot.outward) n = side.frame.direction(n);
        shoot.length = length_of(shoot.path);
        shoots.push_back(std::move(shoot));
    };
    for (const Ivy& plant : ivies) {
        const Side& side = all[static_cast<std::size_t>(plant.side)];
        for (int i = 0; i < plant.shoots; ++i) place(ivy(side, plant, random), side);
    }
    for (const Fall& plant : falls) {
        const Side& side = all[static_cast<std::size_t>(plant.side)];
        for (int i = 0; i < plant.shoots; ++i) place(fall(side, plant, random), side);
    }
    return shoots;
}

}  // namespace raycache::tracer::courtyard
