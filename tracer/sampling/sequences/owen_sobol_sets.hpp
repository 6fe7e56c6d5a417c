// Padded sets of Owen-scrambled Sobol dimensions: B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020.
// Dimensions come in sets of s; each set is the first s Sobol dimensions in a shuffled order of its own, each dimension
// with a nested uniform scrambling of its own.
#pragma once

#include "tracer/sampling/owen_scramble.hpp"
#include "tracer/sampling/sequence.hpp"
#include "tracer/sampling/sequences/sobol_directions.hpp"

namespace raycache::tracer {

class OwenSobolSets final : public Sequence {
public:
    OwenSobolSets(std::uint32_t s, std::uint64_t seed)
        : s_(s), shuffle_(seed, HashPurpose::set_shuffle), scramble_(seed, HashPurpose::point_scramble) {}

    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        const std::uint32_t shuffled = shuffle_index(index, shuffle_.words(dimension / s_, 0, 0));
        return owen_scramble(digital_point(directions_[dimension % s_], shuffled), scramble_.words(dimension, 0, 0));
    }
    std::uint32_t dimensions() const override { return static_cast<std::uint32_t>(directions_.size()); }
    std::uint32_t net_dimensions() const override { return s_; }
    bool equal_cells(std::uint32_t first, std::span<const unsigned> bits, unsigned m) const override {
        return tracer::equal_cells(std::span(directions_).subspan(first % s_, bits.size()), bits, m);
    }

private:
    std::uint32_t s_;
    HashKey shuffle_, scramble_;
    const std::vector<DirectionNumbers>& directions_ = sobol_directions();
};

}  // namespace raycache::tracer
