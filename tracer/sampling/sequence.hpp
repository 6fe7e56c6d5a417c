// A low-discrepancy sequence: point i, dimension d, in 32-bit fixed point (u32 / 2^32). One file per sequence in
// sequences/, one line each in sequences/registry.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace raycache::tracer {

class Sequence {
public:
    virtual ~Sequence() = default;
    /// Coordinate `dimension` of point `index`. Precondition: dimension < dimensions() (checked once by
    /// SamplingStrategy).
    virtual std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const = 0;
    virtual std::uint32_t dimensions() const = 0;
    /// How many points there are: indices 0 … points()-1 are valid.
    virtual std::uint64_t points() const { return std::uint64_t{1} << 32; }

    /// s where every aligned group of s dimensions is a digital net in base 2 of its own, for every N = 2^m; 0 where
    /// dimensions are no nets in base 2.
    virtual std::uint32_t net_dimensions() const { return 0; }
    /// Whether the first 2^m points fall equally often into each cell that the leading bits[i] bits of the dimensions
    /// first + i make together. Precondition: these dimensions are of one net, first / net_dimensions() that of the
    /// last; or net_dimensions() is 0; m <= 32.
    virtual bool equal_cells(std::uint32_t /*first*/, std::span<const unsigned> /*bits*/, unsigned /*m*/) const {
        return false;
    }
    /// The largest k such that all 2^(k s) cells of side 2^-k of the dimensions first … first+s-1 are equal in that
    /// sense. The same precondition.
    unsigned equal_cell_bits(std::uint32_t first, unsigned s, unsigned m) const {
        std::vector<unsigned> bits(s, 1);
        while (bits.front() <= 32 && equal_cells(first, bits, m)) bits.assign(s, bits.front() + 1);
        return bits.front() - 1;
    }

    const std::string& name() const { return name_; }

private:
    friend std::unique_ptr<Sequence> make_sequence(const std::string& name, std::uint64_t seed);
    std::string name_;
};

struct SequenceEntry {
    std::string name, description;
    std::unique_ptr<Sequence> (*make)(std::uint64_t seed);
    bool reads_seed = true;  ///< plain sequences do not
};
const std::vector<SequenceEntry>& sequences();

/// Throws UsageError that lists the valid names.
std::unique_ptr<Sequence> make_sequence(const std::string& name, std::uint64_t seed = 0);

}  // namespace raycache::tracer
