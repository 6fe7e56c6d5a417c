#include <array>
#include <bit>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "traces/block_format.hpp"
#include "traces/compression.hpp"
#include "traces/lane_stack.hpp"
#include "traces/schedule.hpp"
#include "traces/stack_search.hpp"
#include "traces/successors.hpp"
#include "traces/writer.hpp"

namespace raycache::traces {
namespace {

using NextIn = std::array<std::uint32_t, 3>;

/// Turns warps into the raw streams of a block. Kept per thread for its memory.
class Encoder {
public:
    Block encode(const Header&, std::span<const WarpTrace>);

private:
    void encode_warp(const Header&, Schedule&, const WarpTrace&);
    void encode_control(const Schedule&, const Record&);
    void encode_starts(Schedule&, std::uint32_t mask, const Successor*);
    template <unsigned fixed_degree>
    [[gnu::noinline]] void encode_access(const Header&, Schedule&, const Record&, const std::uint32_t*,
                                         const Successor*, const NextIn&);
    std::uint8_t spell(Schedule&, unsigned lane, std::uint32_t next_region, std::uint32_t next_element,
                       const Successor&);
    Block assemble(std::span<const WarpTrace>);

    Bytes control_, linked_, other_;
    std::array<Bytes, 5> literals_;
    std::uint8_t *linked_end_ = nullptr, *other_end_ = nullptr;
    std::uint64_t rays_ = 0, records_ = 0, lane_accesses_ = 0;
    std::uint32_t run_ = 0;  ///< predicted records since the last one in `control_`
    std::array<LaneStack, warp_lanes> stacks_;
    std::array<std::uint32_t, 256> recent_{};  ///< per region, the latest literal of the warp
    SuccessorFinder successors_;
};

/// A symbol that is no depth, and the literal if it is one. `next_…` is what `sequential` would mean.
std::uint8_t Encoder::spell(Schedule& schedule, unsigned lane, std::uint32_t next_region, std::uint32_t next_element,
                            const Successor& to) {
    if (to.none()) return format::end_of_ray;
    const std::uint32_t bit = 1u << lane;
    schedule.waiting[to.region] |= bit;
    if (to.region == next_region && to.element() == next_element) {
        schedule.sequential |= bit;
        return format::sequential;
    }
    const std::uint32_t code = zigzag(to.element() - std::exchange(recent_[to.region], to.element()));
    literals_[0].push_back(static_cast<std::uint8_t>(to.region));
    for (unsigned i = 0; i < 4; ++i) literals_[1 + i].push_back(static_cast<std::uint8_t>(code >> (8 * i)));
    return format::literal;
}

void Encoder::encode_starts(Schedule& schedule, std::uint32_t mask, const Successor* to) {
    for (std::uint32_t left = mask; left != 0; left &= left - 1, ++to) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        stacks_[lane].clear();
        *other_end_++ = spell(schedule, lane, 0, 0, *to);
    }
}

/// `fixed_degree` is the degree of the record's region, known to the compiler; or `runtime`.
constexpr unsigned runtime = ~0u;

template <unsigned fixed_degree>
void Encoder::encode_access(const Header& header, Schedule& schedule, const Record& record,
                            const std::uint32_t* elements, const Successor* to, const NextIn& next_in) {
    const Region& region = header.regions[record.region];
    const unsigned degree = fixed_degree == runtime ? region.degree : fixed_degree;
    const std::uint32_t* table = region.links.data();
    std::uint8_t*& end = degree != 0 ? linked_end_ : other_end_;
    std::uint8_t* out = end;
    const std::uint32_t high = std::uint32_t{record.region} << element_bits;
    const bool linkable = record.region < unlinkable;
    std::uint32_t sequential = 0;
    for (std::uint32_t left = record.mask; left != 0; left &= left - 1, ++elements, ++to) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        const std::uint32_t element = *elements, word = to->word;
        const std::uint32_t* links = table + std::size_t{element} * degree;
        LaneStack& stack = stacks_[lane];
        unsigned symbol = not_found;
        if (degree == 0 && linkable && word == (high | element) + 1) {
            symbol = format::sequential;
            sequential |= left & (0u - left);
        } else if (word < no_word) [[likely]] {
            symbol = find_depth(stack, links, degree, word);
            if (symbol != not_found) [[likely]]
                stack.follow(links, degree, symbol);
        }
        if (symbol == not_found) [[unlikely]]
            symbol = spell(schedule, lane, record.region, element + 1, *to);
        *out++ = static_cast<std::uint8_t>(symbol);
    }
    end = out;
    schedule.sequential |= sequential;
    for (unsigned r = 0; r < unlinkable; ++r) schedule.waiting[r] |= next_in[r] & record.mask;
}

void Encoder::encode_control(const Schedule& schedule, const Record& record) {
    const std::uint8_t region = schedule.predicted_region();
    const std::uint32_t waiting = record.is_access() ? schedule.waiting[record.region] : 0;
    const std::uint32_t predicted = record.is_access() ? schedule.predicted_mask(record.region) : 0;
    std::uint8_t tag = 0;
    if (record.region != region) tag |= format::tag_region;
    if (!record.is_access()) tag |= format::tag_region;
    if (record.mask != predicted) tag |= format::tag_mask;
    if (record.ray != schedule.ray || record.bounce != schedule.bounce) tag |= format::tag_ray;
    if (tag == 0) {
        ++run_;
        return;
    }
    append_varint(control_, std::exchange(run_, 0));
    control_.push_back(tag);
    if (tag & format::tag_region) control_.push_back(record.region);
    if (tag & format::tag_mask) append(control_, record.is_access() ? waiting & ~record.mask : record.mask);
    if (tag & format::tag_ray) {
        control_.push_back(static_cast<std::uint8_t>(record.ray));
        control_.push_back(record.bounce);
    }
}

void Encoder::encode_warp(const Header& header, Schedule& schedule, const WarpTrace& warp) {
    successors_.find(header, warp);
    rays_ += successors_.rays;
    append_varint(control_, static_cast<std::uint32_t>(warp.records.size()));
    append_varint(control_, static_cast<std::uint32_t>(warp.elements.size()));
    append_varint(control_, successors_.lanes_at_start);
    recent_.fill(0);
    for (LaneStack& stack : stacks_) stack.clear();
    schedule.start_warp();

    std::array<Successor, warp_lanes> first;
    unsigned firsts = 0;
    for (unsigned lane = 0; lane < warp_lanes; ++lane)
        if (!successors_.at_start[lane].none()) first[firsts++] = successors_.at_start[lane];
    encode_starts(schedule, successors_.lanes_at_start, first.data());

    const Successor* to = successors_.after.data();
    const std::uint32_t* elements = warp.elements.data();
    const NextIn* next_in = successors_.next_in.data();
    for (const Record& record : warp.records) {
        encode_control(schedule, record);
        schedule.begin(record);
        const unsigned count = record.lanes();
        if (!record.is_access()) {
            encode_starts(schedule, record.mask, to);
        } else {
            switch (header.regions[record.region].degree) {
                case 0:
                    encode_access<0>(header, schedule, record, elements, to, *next_in);
                    break;
                case 2:
                    encode_access<2>(header, schedule, record, elements, to, *next_in);
                    break;
                case 4:
                    encode_access<4>(header, schedule, record, elements, to, *next_in);
                    break;
                case 8:
                    encode_access<8>(header, schedule, record, elements, to, *next_in);
                    break;
                default:
                    encode_access<runtime>(header, schedule, record, elements, to, *next_in);
                    break;
            }
            elements += count;
        }
        to += count;
        ++next_in;
    }
    if (run_ != 0) append_varint(control_, std::exchange(run_, 0));
}

Block Encoder::encode(const Header& header, std::span<const WarpTrace> warps) {
    if (warps.empty() || warps.size() > format::max_block_warps)
        throw Error(fmt::format("trace block: expected 1 to {} warps, found {}; split the launch into more blocks",
                                format::max_block_warps, warps.size()));
    rays_ = records_ = lane_accesses_ = 0;
    std::uint64_t lanes = 0;
    for (std::size_t i = 0; i < warps.size(); ++i) {
        if (warps[i].launch != warps[0].launch || warps[i].warp != warps[0].warp + i)
            throw Error(
                fmt::format("trace block: expected launch {} warp {}, found launch {} warp {}; a block holds "
                            "consecutive warps of one launch",
                            warps[0].launch, warps[0].warp + i, warps[i].launch, warps[i].warp));
        records_ += warps[i].records.size();
        lane_accesses_ += warps[i].elements.size();
        for (const Record& record : warps[i].records) lanes += record.lanes();
    }
    if (lanes > format::max_block_lanes || records_ > format::max_block_records)
        throw Error(
            fmt::format("trace block: expected at most {} lane accesses and rays, found {} in {} warps; put fewer "
                        "warps into a block",
                        format::max_block_lanes, lanes, warps.size()));
    control_.clear();
    for (Bytes& plane : literals_) plane.clear();
    const std::size_t symbols = lanes + warp_lanes * warps.size();
    if (linked_.size() < symbols) linked_.resize(symbols);
    if (other_.size() < symbols) other_.resize(symbols);
    linked_end_ = linked_.data();
    other_end_ = other_.data();
    run_ = 0;
    Schedule schedule(header);
    for (const WarpTrace& warp : warps) encode_warp(header, schedule, warp);
    return assemble(warps);
}

Block Encoder::assemble(std::span<const WarpTrace> warps) {
    Block block{
        warps[0].launch, warps[0].warp, static_cast<std::uint32_t>(warps.size()), records_, lane_accesses_, rays_, {}};
    BlockHead head{0, block.launch, block.first_warp, block.warps, block.records, block.lane_accesses, block.rays, {}};
    const auto until = [](const Bytes& buffer, const std::uint8_t* end) {
        return std::span(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
    };
    const std::array<std::span<const std::uint8_t>, format::streams> raw{control_,
                                                                         until(linked_, linked_end_),
                                                                         until(other_, other_end_),
                                                                         literals_[0],
                                                                         literals_[1],
                                                                         literals_[2],
                                                                         literals_[3],
                                                                         literals_[4]};
    block.bytes.resize(format::block_head_bytes);
    for (unsigned s = 0; s < format::streams; ++s)
        head.sizes[s] = {static_cast<std::uint32_t>(raw[s].size()),
                         static_cast<std::uint32_t>(
                             compress(raw[s], s == format::control ? Effort::fast : Effort::entropy, block.bytes))};
    head.bytes = static_cast<std::uint32_t>(block.bytes.size() + format::checksum_bytes);
    store_block_head(head, block.bytes.data());
    seal(block.bytes);
    return block;
}

}  // namespace

Block encode_block(const Header& header, std::span<const WarpTrace> warps) {
    thread_local const auto encoder = std::make_unique<Encoder>();
    return encoder->encode(header, warps);
}

}  // namespace raycache::traces
