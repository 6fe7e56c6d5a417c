// Traces to test with: rays that walk a random BVH in lock step, and records without any sense. Equal arguments give
// equal traces on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

struct Sample {
    raycache::traces::Header header;
    std::vector<raycache::traces::WarpTrace> warps;  ///< of all launches, in order
};

/// Numbers that only the seed determines (the standard library's distributions differ between implementations).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x632be59bd9b4e019u) {}
    std::uint32_t bits() {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 7;
        state_ ^= state_ << 17;
        return static_cast<std::uint32_t>(state_ >> 32);
    }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((std::uint64_t{bits()} * n) >> 32); }
    bool chance(std::uint32_t percent) { return below(100) < percent; }

private:
    std::uint64_t state_;
};

struct Shape {
    std::uint64_t seed = 1;
    unsigned degree = 2;  ///< children of a node
    std::uint32_t leaves = 40, launches = 2, warps = 5;
    bool breadth_first = false;  ///< order of the nodes
};

/// A camera, a shadow and a bounce ray per lane through a random tree, by a while-while loop.
Sample bvh_walks(const Shape&);

/// Records drawn at random: any region, mask, ray and element; also lanes that read before their first ray start.
Sample noise(const Shape&);

/// Screen-space reads: texels around a pixel, in a region without links.
Sample texel_reads(const Shape&);

/// Two kernels of a wavefront per launch: all kinds of buffers, a sort, and warps without records.
Sample wavefront_buffers(const Shape&);

/// Writes all warps, `per_block` to a block.
void write_sample(const Sample&, const std::string& path, std::size_t per_block = 2);

/// All warps of a file.
std::vector<raycache::traces::WarpTrace> read_all(const std::string& path);
