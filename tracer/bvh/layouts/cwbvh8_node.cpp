#include "tracer/bvh/layouts/cwbvh8_node.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raycache::tracer {
namespace {

/// The float that a plane is decoded to.
float plane(float origin, int steps, float scale) { return origin + static_cast<float>(steps) * scale; }

/// The least scale by which 255 steps reach from `lower` to `upper`.
std::uint8_t exponent_of(float lower, float upper) {
    constexpr int bias = 127, least = 1, most = 254;
    const double step = (double{upper} - lower) / 255;
    int exponent = step > 0 ? std::clamp(std::ilogb(step) + bias, least, most) : least;
    while (exponent < most && plane(lower, 255, std::ldexp(1.0F, exponent - bias)) < upper) ++exponent;
    return static_cast<std::uint8_t>(exponent);
}

/// The most steps that decode to no more than `value`.
int steps_below(float origin, float scale, float value) {
    int steps = static_cast<int>(std::clamp(std::floor((double{value} - origin) / scale), 0.0, 255.0));
    while (steps > 0 && plane(origin, steps, scale) > value) --steps;
    return steps;
}

/// The fewest that decode to no less.
int steps_above(float origin, float scale, float value) {
    int steps = static_cast<int>(std::clamp(std::ceil((double{value} - origin) / scale), 0.0, 255.0));
    while (steps < 255 && plane(origin, steps, scale) < value) ++steps;
    return steps;
}

}  // namespace

Box Cwbvh8Node::box(unsigned slot) const {
    const auto corner = [&](const std::uint8_t(&planes)[3][8]) {
        return Vec3{plane(origin[0], planes[0][slot], scale(0)), plane(origin[1], planes[1][slot], scale(1)),
                    plane(origin[2], planes[2][slot], scale(2))};
    };
    return {corner(lower), corner(upper)};
}

void quantise(const Box& whole, const std::array<Box, 8>& boxes, Cwbvh8Node& node) {
    for (int axis = 0; axis < 3; ++axis) {
        const float origin = whole.lower[axis];
        node.origin[axis] = origin;
        node.exponent[axis] = exponent_of(origin, whole.upper[axis]);
        const float scale = node.scale(axis);
        for (unsigned slot = 0; slot < 8; ++slot) {
            const float lower = boxes[slot].lower[axis], upper = boxes[slot].upper[axis];
            const bool empty = lower > upper;
            node.lower[axis][slot] = static_cast<std::uint8_t>(empty ? 255 : steps_below(origin, scale, lower));
            node.upper[axis][slot] = static_cast<std::uint8_t>(empty ? 0 : steps_above(origin, scale, upper));
        }
    }
}

std::array<std::uint8_t, 8> octant_slots(std::span<const Vec3> centres) {
    const auto cost = [&](std::size_t child, unsigned slot) {  // small: met early by rays towards the slot's octant
        const Vec3 c = centres[child];
        return ((slot & 4) != 0 ? -c.x : c.x) + ((slot & 2) != 0 ? -c.y : c.y) + ((slot & 1) != 0 ? -c.z : c.z);
    };
    std::array<std::uint8_t, 8> slot_of{};
    unsigned free_slots = 0xff, open = (1U << centres.size()) - 1;
    while (open != 0) {
        float best = std::numeric_limits<float>::infinity();
        std::size_t best_child = 0;
        unsigned best_slot = 8;
        for (std::size_t child = 0; child < centres.size(); ++child)
            for (unsigned slot = 0; slot < 8; ++slot)
                if ((open >> child & 1) != 0 && (free_slots >> slot & 1) != 0 &&
                    (best_slot == 8 || cost(child, slot) < best)) {
                    best = cost(child, slot);
                    best_child = child;
                    best_slot = slot;
                }
        slot_of[best_child] = static_cast<std::uint8_t>(best_slot);
        free_slots &= ~(1U << best_slot);
        open &= ~(1U << best_child);
    }
    return slot_of;
}

}  // namespace raycache::tracer
