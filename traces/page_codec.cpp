#include "traces/page_codec.hpp"

#include <bit>
#include <utility>
#include <vector>

#include "traces/compression.hpp"

namespace raycache::traces {
namespace {

constexpr std::uint64_t last_page = ~std::uint64_t{0} >> PageTable::page_bits;

/// Ascending, and nothing beyond the end of memory.
void check_table(const Region& region, unsigned index, const Origin& origin) {
    const auto& numbers = region.pages.numbers();
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] > last_page || (i > 0 && numbers[i] <= numbers[i - 1]))
            refuse(
                origin, fmt::format("page {} of region {}", i, index),
                i > 0 ? fmt::format("{} to {}", numbers[i - 1] + 1, last_page) : fmt::format("at most {}", last_page),
                fmt::format("{}", numbers[i]), recapture);
    if (region.address(region.count - 1) > ~std::uint64_t{0} - (region.element_size - 1))
        refuse(origin, fmt::format("last element of region {}", index), "an end below 2^64",
               hex64(region.address(region.count - 1)), recapture);
}

}  // namespace

std::uint64_t pages_of(const Region& region) {
    return (std::uint64_t{region.count} * region.stride + PageTable::page_bytes - 1) / PageTable::page_bytes;
}

void check_paged(const Region& region, unsigned index, const Origin& at) {
    const auto what = [&](const char* field) { return fmt::format("{} of region {}, which has pages", field, index); };
    if (!std::has_single_bit(region.stride) || region.stride > PageTable::page_bytes)
        refuse(at + 16, what("stride"), fmt::format("a power of two up to {}", PageTable::page_bytes),
               fmt::format("{}", region.stride), recapture);
    if (region.base != 0) refuse(at + 8, what("base address"), "0", hex64(region.base), recapture);
    if (region.degree != 0) refuse(at + 1, what("degree"), "0", fmt::format("{}", region.degree), recapture);
    if (region.count == 0) refuse(at + 20, what("count"), "at least 1", "0", recapture);
}

void encode_pages(const Region& region, unsigned index, const Origin& origin, Bytes& out) {
    if (region.pages.count() != pages_of(region))
        refuse(origin, fmt::format("pages of region {}", index), fmt::format("{}", pages_of(region)),
               fmt::format("{}", region.pages.count()), recapture);
    check_table(region, index, origin);
    Bytes raw, stored;
    std::uint64_t before = 0;
    for (const std::uint64_t number : region.pages.numbers()) append(raw, number - std::exchange(before, number));
    compress(raw, Effort::small, stored);
    append(out, static_cast<std::uint64_t>(stored.size()));
    append(out, stored);
}

std::uint64_t decode_pages(Region& region, unsigned index, std::span<const std::uint8_t> stored, const Origin& origin,
                           MemoryBudget& budget) {
    constexpr std::uint64_t head = sizeof(std::uint64_t);
    const std::uint64_t bytes = stored.size() < head ? 0 : load<std::uint64_t>(stored.data());
    if (stored.size() < head || bytes > stored.size() - head)
        refuse(origin, fmt::format("pages of region {}", index), "a table within the head", "less", recapture);
    const std::uint64_t count = pages_of(region);
    budget.charge(count * sizeof(std::uint64_t), origin.path, "pages of its regions");
    const MemoryHold raw_hold(budget, count * sizeof(std::uint64_t), origin.path,
                              "decompressing the pages of its regions");
    Bytes raw;
    decompress(stored.subspan(head, bytes), count * sizeof(std::uint64_t), origin + head, raw);
    std::vector<std::uint64_t> numbers(count);
    std::uint64_t number = 0;
    for (std::uint64_t i = 0; i < count; ++i)
        numbers[i] = number += load<std::uint64_t>(raw.data() + i * sizeof(std::uint64_t));
    region.pages = PageTable(std::move(numbers));
    check_table(region, index, origin);
    return head + bytes;
}

}  // namespace raycache::traces
