#include "tracer/sampling/blue_noise_mask.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {
namespace {

constexpr std::size_t area = std::size_t{mask_side} * mask_side;

/// Pixels that are on, and how crowded each place is by them.
class Pattern {
public:
    Pattern() : on_(area), crowding_(area), weights_(area) {
        constexpr double sigma = 1.5, scale = 1 << 24;
        for (std::uint32_t i = 0; i < area; ++i) {
            const double x = std::min(i % mask_side, mask_side - i % mask_side);
            const double y = std::min(i / mask_side, mask_side - i / mask_side);
            weights_[i] = std::llround(scale * std::exp(-(x * x + y * y) / (2 * sigma * sigma)));
        }
    }

    bool on(std::uint32_t i) const { return on_[i]; }
    void set(std::uint32_t place, bool on) {
        if (on_[place] == on) return;
        on_[place] = on;
        const std::uint32_t px = place % mask_side, py = place / mask_side;
        for (std::uint32_t y = 0; y < mask_side; ++y) {
            const std::int64_t* row = &weights_[std::size_t{(y - py) % mask_side} * mask_side];
            for (std::uint32_t x = 0; x < mask_side; ++x) {
                const std::int64_t weight = row[(x - px) % mask_side];
                crowding_[std::size_t{y} * mask_side + x] += on ? weight : -weight;
            }
        }
    }
    std::uint32_t tightest_cluster() const {
        std::uint32_t best = 0;
        std::int64_t most = -1;
        for (std::uint32_t i = 0; i < area; ++i) {
            if (!on_[i] || crowding_[i] <= most) continue;
            most = crowding_[i];
            best = i;
        }
        return best;
    }
    std::uint32_t largest_void() const {
        std::uint32_t best = 0;
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (std::uint32_t i = 0; i < area; ++i) {
            if (on_[i] || crowding_[i] >= least) continue;
            least = crowding_[i];
            best = i;
        }
        return best;
    }

private:
    std::vector<std::uint8_t> on_;
    std::vector<std::int64_t> crowding_, weights_;
};

/// About a tenth of the pixels at random, then moved from the tightest cluster to the largest void until that changes
/// nothing.
Pattern first_pattern(std::uint64_t seed) {
    Pattern pattern;
    const HashKey key(seed, HashPurpose::mask_detail);
    for (std::uint32_t i = 0; i < area; ++i)
        if (key.words(i, 0, 0)[0] < 0xFFFFFFFFU / 10) pattern.set(i, true);
    for (;;) {
        const std::uint32_t from = pattern.tightest_cluster();
        pattern.set(from, false);
        const std::uint32_t to = pattern.largest_void();
        pattern.set(to, true);
        if (to == from) return pattern;
    }
}

}  // namespace

BlueNoiseMask make_blue_noise_mask(std::uint64_t seed) {
    const Pattern first = first_pattern(seed);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < area; ++i) count += first.on(i);

    BlueNoiseMask ranks{};
    Pattern fewer = first;
    for (std::uint32_t rank = count; rank-- > 0;) {
        const std::uint32_t place = fewer.tightest_cluster();
        ranks[place] = static_cast<std::uint16_t>(rank);
        fewer.set(place, false);
    }
    // Beyond half, Ulichney takes the tightest cluster of pixels that are off: on a torus the same as the largest void.
    Pattern more = first;
    for (std::uint32_t rank = count; rank < area; ++rank) {
        const std::uint32_t place = more.largest_void();
        ranks[place] = static_cast<std::uint16_t>(rank);
        more.set(place, true);
    }
    return ranks;
}

}  // namespace raycache::tracer
