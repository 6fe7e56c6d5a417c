// Uniform whole numbers, one after another, from the hash of hash.hpp: the same on every machine.
#pragma once

#include <cstdint>
#include <limits>

#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

class RandomStream {
public:
    /// `stream`: which of 2^32 unrelated streams of this seed and purpose.
    RandomStream(std::uint64_t seed, HashPurpose purpose, std::uint32_t stream = 0)
        : key_(seed, purpose), stream_(stream) {}

    /// Uniform in 0 … bound-1, exactly: draws from the incomplete last block of 2^64 are thrown away.
    std::uint64_t below(std::uint64_t bound) {
        const std::uint64_t excess = (0 - bound) % bound;  // 2^64 mod bound
        for (;;) {
            const HashWords words = key_.words(counter_++, stream_, 0);
            const std::uint64_t draw = std::uint64_t{words[0]} << 32 | words[1];
            if (draw <= std::numeric_limits<std::uint64_t>::max() - excess) return draw % bound;
        }
    }

private:
    HashKey key_;
    std::uint32_t stream_;
    std::uint32_t counter_ = 0;
};

}  // namespace raycache::tracer
