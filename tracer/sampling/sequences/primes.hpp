// The bases of Halton sequences.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace raycache::tracer {

/// 2, 3, 5, …
inline std::vector<std::uint32_t> first_primes(std::size_t count) {
    std::vector<std::uint32_t> primes;
    primes.reserve(count);
    for (std::uint32_t candidate = 2; primes.size() < count; ++candidate) {
        bool is_prime = true;
        for (const std::uint32_t p : primes) {
            if (p * p > candidate) break;
            if (candidate % p == 0) {
                is_prime = false;
                break;
            }
        }
        if (is_prime) primes.push_back(candidate);
    }
    return primes;
}

}  // namespace raycache::tracer
