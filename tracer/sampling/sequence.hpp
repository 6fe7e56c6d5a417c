// A low-discrepancy sequence: point i, dimension d, in 32-bit fixed point (u32 / 2^32). One file per sequence in
// sequences/, one line each in sequences/registry.cpp.
#pragma once

#include <cstdint>
#include <memory>
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
};

struct SequenceEntry {
    std::string name, description;
    std::unique_ptr<Sequence> (*make)();
};
const std::vector<SequenceEntry>& sequences();

/// Throws UsageError that lists the valid names.
std::unique_ptr<Sequence> make_sequence(const std::string& name);

}  // namespace raycache::tracer
