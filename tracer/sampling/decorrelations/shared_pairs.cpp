#include "tracer/sampling/decorrelations/shared_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint32_t max_dimension = 1U << 16;

std::uint32_t parse_pair(const std::string& word, const std::string& whole) {
    for (const NamedPair& pair : named_pairs)
        if (word == pair.name) return pair.first;
    std::uint32_t first = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), first);
    if (error != std::errc{} || stop != word.data() + word.size() || first % 2 != 0 || first >= max_dimension)
        throw UsageError(fmt::format(
            "sampling: share must be sets, or pairs of dimensions joined by +: camera, light0, first-bounce "
            "or the even number of a pair's first dimension, found {}: give share=first-bounce",
            whole));
    return first;
}

/// Of that pair: leading bits of its first and second dimension.
std::array<unsigned, 2> free_bits_of(std::uint32_t first, unsigned m, const Sequence& sequence) {
    const unsigned k = sequence.equal_cell_bits(first, 2, m);
    for (const std::array<unsigned, 2>& longer : {std::array{k + 1, k}, std::array{k, k + 1}})
        if (sequence.equal_cells(first, longer, m)) return longer;
    return {k, k};
}

}  // namespace

std::vector<std::uint32_t> parse_pairs(const std::string& text) {
    std::vector<std::uint32_t> pairs;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(text.find('+', from), text.size());
        const std::uint32_t first = parse_pair(text.substr(from, to - from), text);
        if (std::find(pairs.begin(), pairs.end(), first) != pairs.end())
            throw UsageError(fmt::format("sampling: share names dimensions {}, {} twice, found {}: name each pair once",
                                         first, first + 1, text));
        pairs.push_back(first);
        from = to + 1;
    }
    return pairs;
}

SharedPairs::SharedPairs(const std::vector<std::uint32_t>& pairs, int bits, const SampleSet& samples,
                         const Sequence& sequence) {
    require_net("net-micro-jitter", sequence, 2);
    const unsigned m = require_power_of_two("net-micro-jitter", samples.spp);
    const std::uint32_t used = samples.dimensions == 0 ? sequence.dimensions() : samples.dimensions;
    std::vector<std::uint32_t> shared;  // dimensions
    for (const std::uint32_t first : pairs) {
        if (first + 1 >= used) continue;
        const std::array<unsigned, 2> free = free_bits_of(first, m, sequence);
        free_ = std::max(free_, free[0] + free[1]);
        for (std::uint32_t i = 0; i < 2; ++i) {
            shared.push_back(first + i);
            if (bits < 0) share(first + i, free[i]);
        }
    }
    if (bits < 0 || shared.empty()) return;
    const auto dealt = static_cast<unsigned>(bits), places = static_cast<unsigned>(shared.size());
    for (unsigned i = 0; i < places; ++i)
        share(shared[i], std::min(32U, dealt / places + (i < dealt % places ? 1 : 0)));
}

void SharedPairs::share(std::uint32_t dimension, unsigned bits) {
    if (masks_.size() <= dimension) masks_.resize(dimension + 1);
    masks_[dimension] = bits == 0 ? 0 : ~0U << (32 - bits);
    bits_ += bits;
}

std::string SharedPairs::parameters() const { return fmt::format("bits={} free={}", bits_, free_); }

std::string SharedPairs::warning() const {
    if (bits_ <= free_) return {};
    return fmt::format(
        "net-micro-jitter shares {} bits of its points between pixels where {} are free: beyond them neighbouring "
        "pixels err together, and the mean may be off (raycache quality: R8, z)",
        bits_, free_);
}

}  // namespace raycache::tracer
