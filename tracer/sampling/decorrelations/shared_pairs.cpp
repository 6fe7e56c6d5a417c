#include "tracer/sampling/decorrelations/shared_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <span>

#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint32_t max_dimension = 1U << 16;

std::uint32_t parse_pair(const std::string& word, const std::string& whole) {
    for (const NamedPair& pair : named_pairs)
        if (word == pair.name) return pair.first;
    std::uint32_t first = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), first);
    if (error != std::errc{} || stop != word.data() + word.size() || first % 2 != 0 || first >= max_dimension) {
        std::vector<std::string> names{"sets"};
        for (const NamedPair& pair : named_pairs) names.emplace_back(pair.name);
        throw UsageError(fmt::format(
            "sampling: share must be sets, or pairs of dimensions joined by +: camera, light0, first-bounce "
            "or the even number of a pair's first dimension, found {}: give share=first-bounce{}",
            whole, did_you_mean(word, names)));
    }
    return first;
}

/// Of that pair: leading bits of its first and second dimension. Both alike, as many as are free; then what more of one.
std::array<unsigned, 2> free_bits_of(std::uint32_t first, unsigned m, const Sequence& sequence) {
    const unsigned k = sequence.equal_cell_bits(first, 2, m);
    const auto longer = [&](unsigned which) {
        std::array<unsigned, 2> bits{k, k};
        while (bits[which] < m) {
            ++bits[which];
            if (sequence.equal_cells(first, bits, m)) continue;
            --bits[which];
            break;
        }
        return bits;
    };
    const std::array<unsigned, 2> a = longer(0), b = longer(1);
    return b[1] > a[0] ? b : a;
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
    std::vector<std::uint32_t> dimensions;
    for (const std::uint32_t first : pairs) {
        if (first + 1 >= used) continue;
        const std::array<unsigned, 2> free = free_bits_of(first, m, sequence);
        most_free_ = std::max(most_free_, free[0] + free[1]);
        bits_.resize(std::max<std::size_t>(bits_.size(), first + 2));
        for (std::uint32_t i = 0; i < 2; ++i) {
            dimensions.push_back(first + i);
            if (bits < 0) bits_[first + i] = free[i];
        }
    }
    for (int dealt = 0; dealt < bits && !dimensions.empty(); ++dealt) {
        unsigned& next = bits_[dimensions[static_cast<unsigned>(dealt) % dimensions.size()]];
        next = std::min(next + 1, 32U);
    }
    for (const unsigned b : bits_) masks_.push_back(b == 0 ? 0 : ~0U << (32 - b));
    is_free_ = is_free(m, sequence);
}

bool SharedPairs::is_free(unsigned m, const Sequence& sequence) const {
    const auto some = [](unsigned bits) { return bits != 0; };
    const auto from = std::find_if(bits_.begin(), bits_.end(), some);
    if (from == bits_.end()) return true;
    const auto first = static_cast<std::uint32_t>(from - bits_.begin()) / 2 * 2;
    const auto end =
        static_cast<std::uint32_t>(std::find_if(bits_.rbegin(), bits_.rend(), some).base() - bits_.begin());
    // Of dimensions of different nets nothing is known together.
    if (first / sequence.net_dimensions() != (end - 1) / sequence.net_dimensions()) return false;
    return sequence.equal_cells(first, std::span(bits_).subspan(first, end - first), m);
}

unsigned SharedPairs::bits() const { return std::accumulate(bits_.begin(), bits_.end(), 0U); }

std::string SharedPairs::parameters() const { return fmt::format("bits={} free={}", bits(), most_free_); }

std::string SharedPairs::warning() const {
    if (is_free_) return {};
    return fmt::format(
        "net-micro-jitter shares {} bits of its points between pixels that are not free together (of one pair {} are): "
        "neighbouring pixels err together, and the mean may be off (raycache quality: R8, z)",
        bits(), most_free_);
}

}  // namespace raycache::tracer
