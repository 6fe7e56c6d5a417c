#include "traces/accelsim/address_regions.hpp"

#include <fmt/format.h>

#include <bit>
#include <numeric>

#include "traces/error.hpp"

namespace raycache::traces {
namespace {

constexpr std::uint64_t base_step = std::uint64_t{1} << 21;
constexpr std::uint64_t most_elements = (std::uint64_t{1} << 30) - 1;

/// A base with first = base + i * stride for some i; false if there is none.
bool find_base(std::uint64_t first, std::uint64_t stride, std::uint64_t& base) {
    base = first / base_step * base_step;
    // Bases repeat modulo the stride after at most `stride` steps.
    for (std::uint64_t steps = 0; steps < stride; ++steps, base -= base_step) {
        if ((first - base) % stride == 0) return true;
        if (base < base_step) return false;
    }
    return false;
}

}  // namespace

std::vector<CoveredRange> cover(const std::vector<std::uint64_t>& addresses, std::uint32_t size,
                                const std::string& file) {
    const std::uint64_t gap = std::has_single_bit(size) ? ~std::uint64_t{0} : std::uint64_t{1} << 24;
    std::vector<CoveredRange> ranges;
    // The search for a base may put up to `size` steps before the first element in use.
    const std::uint64_t most_span = size * (most_elements - 1) - size * base_step;
    for (std::size_t begin = 0, end; begin < addresses.size(); begin = end) {
        const std::uint64_t first = addresses[begin];
        std::uint64_t spacing = 0;  // divides all distances
        for (end = begin + 1; end < addresses.size(); ++end) {
            if (addresses[end] - addresses[end - 1] > gap || addresses[end] - first > most_span) break;
            spacing = std::gcd(spacing, addresses[end] - first);
        }
        CoveredRange range{first, addresses[end - 1], {}};
        Region& region = range.region;
        region.element_size = region.stride = size;
        if (spacing % size != 0 || !find_base(first, size, region.base))
            throw Error(
                fmt::format("{}: objects of {} bytes from {:#x} on: expected them at multiples of their size from a "
                            "multiple of 2 MiB, as a region of a trace has them, found them at others; import without "
                            "--fuse",
                            file, size, first));
        region.count = static_cast<std::uint32_t>((range.last - region.base) / size + 1);
        ranges.push_back(range);
    }
    return ranges;
}

}  // namespace raycache::traces
