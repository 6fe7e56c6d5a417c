// A node of layout `cwbvh8`: 80 bytes with the quantised boxes of eight children (H. Ylitie, T. Karras, S. Laine:
// Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, HPG 2017).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// A plane of the box of slot s, axis a, is origin[a] + lower[a][s] * scale(a), rounded to float once. Children that
/// are nodes stand side by side from first_node on, in the order of their slots; triangles of all children that are
/// leaves from first_triangle on.
struct alignas(16) Cwbvh8Node {
    float origin[3];           ///< lower corner of the node's box
    std::uint8_t exponent[3];  ///< of scale(): that of a float, with its bias
    std::uint8_t inner;        ///< a bit for each slot that holds a node
    std::uint32_t first_node;
    std::uint32_t first_triangle;
    /// 0: empty. A node: 001, then 24 + slot in five bits. A leaf: as many ones as it has triangles, then the place of
    /// its first behind first_triangle.
    std::uint8_t meta[8];
    std::uint8_t lower[3][8], upper[3][8];

    static constexpr unsigned first_inner = 24;  ///< below: places of triangles

    float scale(int axis) const { return std::bit_cast<float>(std::uint32_t{exponent[axis]} << 23); }
    Box box(unsigned slot) const;  ///< decoded
};
static_assert(sizeof(Cwbvh8Node) == 80);

/// Writes origin, exponents, and planes such that no decoded box is less than the child's. `boxes` by slot; an empty
/// Box for an empty slot.
void quantise(const Box& whole, const std::array<Box, 8>& boxes, Cwbvh8Node&);

/// Gives each child the slot in which rays of most directions meet it in order: slot s lies in the octant whose bits
/// (4: x, 2: y, 1: z) say where the node's upper half is. The paper's auction is replaced by taking the best pair of
/// child and slot until all are placed. `centres` relative to the node's; at most eight.
std::array<std::uint8_t, 8> octant_slots(std::span<const Vec3> centres);

}  // namespace raycache::tracer
