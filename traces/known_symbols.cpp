#include "traces/known_symbols.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <bit>
#include <cstring>

#include "traces/lane_stack.hpp"
#include "traces/record_rules.hpp"

namespace raycache::traces {
namespace {

/// Copies one record's symbols, all of a warp's width where `from` has as many left.
void copy_symbols(const std::uint8_t* from, std::size_t left, unsigned count, std::uint8_t* to) {
    if (left >= warp_lanes) [[likely]]
        std::memcpy(to, from, warp_lanes);
    else
        std::memcpy(to, from, count);
}

/// Bit i: symbol i is no depth, i.e. its highest bit is set. Reads warp_lanes bytes.
std::uint32_t find_special(const std::uint8_t* symbols, unsigned count) {
    const auto wanted = static_cast<std::uint32_t>((std::uint64_t{1} << count) - 1);
#if defined(__SSE2__)
    const auto* wide = reinterpret_cast<const __m128i*>(symbols);
    const auto low = static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_loadu_si128(wide)));
    const auto high = static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_loadu_si128(wide + 1)));
    return (low | high << 16) & wanted;
#else
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < count; ++i) bits |= static_cast<std::uint32_t>(symbols[i] >> 7) << i;
    return bits & wanted;
#endif
}

}  // namespace

void KnownSymbols::look_ahead(const Header& header, const WarpTrace& warp, std::size_t symbols) {
    const std::size_t records = warp.records.size();
    if (next_in_.size() < records) next_in_.resize(records);
    std::size_t lanes = 0, accesses = 0;
    NextIn in{};
    for (std::size_t i = records; i-- > 0;) {
        check_record(header, warp, i);
        const Record record = warp.records[i];
        lanes += record.lanes();
        if (record.is_access()) accesses += record.lanes();
        next_in_[i] = in;
        for (unsigned r = 0; r < in.size(); ++r)
            in[r] = (in[r] & ~record.mask) | (r == record.region ? record.mask : 0);
    }
    check_elements(warp, accesses);
    if ((in[0] | in[1] | in[2]) != 0) reject_record(warp, 0, "expected ray starts before accesses");
    if (symbols != lanes) reject_record(warp, records, fmt::format("expected {} symbols, found {}", lanes, symbols));
}

void KnownSymbols::note_special(Schedule& schedule, std::uint32_t mask, const std::uint8_t* symbols,
                                std::uint32_t special) {
    for (std::uint32_t left = mask; special != 0; left &= left - 1, ++symbols, special >>= 1) {
        if ((special & 1) == 0) continue;
        if (*symbols == format::sequential) {
            schedule.sequential |= left & (0u - left);
        } else if (*symbols == format::literal) {
            literal_of_[static_cast<unsigned>(std::countr_zero(left))] = literals_.size();
            literals_.push_back({});
            open_ |= left & (0u - left);
        }
    }
}

void KnownSymbols::look_up(const Header& header, const WarpTrace& warp, std::size_t i, const std::uint32_t* elements) {
    const Record& record = warp.records[i];
    if (!record.is_access()) reject_record(warp, i, "expected an access after a literal, found a ray start");
    for (std::uint32_t left = record.mask & open_; left != 0; left &= left - 1) {
        const std::uint32_t below = (left & (0u - left)) - 1;
        const std::uint32_t element = elements[std::popcount(record.mask & below)];
        const std::uint32_t limit = header.regions[record.region].count;
        if (element >= limit)
            reject_record(
                warp, i,
                fmt::format("expected elements of region {} below {}, found {}", record.region, limit, element));
        literals_[literal_of_[static_cast<unsigned>(std::countr_zero(left))]] = {record.region, element};
    }
    open_ &= ~record.mask;
}

void KnownSymbols::write(const Header& header, Schedule& schedule, const WarpTrace& warp,
                         std::span<const std::uint8_t> symbols, BlockStreams& out) {
    look_ahead(header, warp, symbols.size());
    out.begin_warp(warp, 0);
    literals_.clear();
    open_ = 0;
    const std::uint8_t* from = symbols.data();
    const std::uint8_t* const end = from + symbols.size();
    const std::uint32_t* elements = warp.elements.data();
    for (std::size_t i = 0; i < warp.records.size(); ++i) {
        const Record record = warp.records[i];
        out.record(schedule, record);
        schedule.begin(record);
        const unsigned count = record.lanes();
        if ((record.mask & open_) != 0) look_up(header, warp, i, elements);
        const bool linked = record.is_access() && header.regions[record.region].degree != 0;
        std::uint8_t*& to = linked ? out.linked_end : out.other_end;
        copy_symbols(from, static_cast<std::size_t>(end - from), count, to);
        if (const std::uint32_t special = find_special(to, count); special != 0)
            note_special(schedule, record.mask, from, special);
        to += count;
        from += count;
        for (unsigned r = 0; r < next_in_[i].size(); ++r) schedule.waiting[r] |= next_in_[i][r] & record.mask;
        if (record.is_access()) elements += count;
    }
    if (open_ != 0) reject_record(warp, warp.records.size(), "expected an access after each literal");
    for (const Literal& literal : literals_) out.literal(literal.region, literal.element);
    out.end_warp();
}

}  // namespace raycache::traces
