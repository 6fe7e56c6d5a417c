#include "traces/block_decoder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <string>
#include <utility>

#include "traces/compression.hpp"
#include "traces/issue_rules.hpp"
#include "traces/lane_stack.hpp"
#include "traces/schedule.hpp"

namespace raycache::traces {
namespace {

/// Undoes Encoder. Kept per thread for its memory.
class Decoder {
public:
    BlockHead decode(const Header&, std::span<const std::uint8_t> block, const Origin&, const MemoryBudget&,
                     std::vector<WarpTrace>& out);

private:
    void decode_warp(const Header&, Schedule&, WarpTrace&);
    void decode_control(Schedule&, Record&);
    void decode_issue(WarpTrace&);
    void decode_starts(const Header&, Schedule&, std::uint32_t mask);
    template <unsigned fixed_degree>
    [[gnu::noinline]] void decode_access(const Header&, Schedule&, const Record&, std::uint32_t* out);
    void spelled(const Header&, Schedule&, unsigned lane, std::uint32_t next_region, std::uint32_t next_element,
                 std::uint8_t symbol);
    [[noreturn]] void fault(const std::string& what, const std::string& expected, const std::string& found) const {
        refuse(origin_, fmt::format("{} (warp {} of the block, record {})", what, warp_, record_), expected, found);
    }
    const std::uint8_t* take(const std::uint8_t*& next, const std::uint8_t* end, unsigned count, const char* what) {
        if (static_cast<std::size_t>(end - next) < count) fault(what, "one per lane", "the end of the stream");
        return std::exchange(next, next + count);
    }
    std::uint32_t control_varint(const char* what) {
        const auto value = control_.take_varint();
        if (!value) fault(what, "a number", "the end of the stream or too many bytes");
        return *value;
    }
    template <class T>
    T control(const char* what) {
        const auto value = control_.take<T>();
        if (!value) fault(what, "a value", "the end of the stream");
        return *value;
    }

    Origin origin_;
    std::size_t warp_ = 0, record_ = 0;
    std::array<Bytes, format::streams> raw_;
    ByteReader control_{{}};
    const std::uint8_t *linked_ = nullptr, *linked_end_ = nullptr, *other_ = nullptr, *other_end_ = nullptr;
    std::size_t literal_ = 0, literals_ = 0;
    std::uint64_t records_left_ = 0, elements_left_ = 0, rays_left_ = 0;
    std::uint32_t run_ = 0;
    std::array<LaneStack, warp_lanes> stacks_;
    std::array<std::uint32_t, warp_lanes> pending_{};  ///< by lane, element of the successor
    std::array<std::uint32_t, 256> recent_{};
};

void Decoder::spelled(const Header& header, Schedule& schedule, unsigned lane, std::uint32_t next_region,
                      std::uint32_t next_element, std::uint8_t symbol) {
    const std::uint32_t bit = 1u << lane;
    std::uint32_t region = next_region, element = next_element;
    if (symbol == format::end_of_ray) return;
    if (symbol == format::sequential) {
        schedule.sequential |= bit;
    } else if (symbol == format::literal) {
        if (literal_ == literals_) fault("literal", "one per literal symbol", "the end of the stream");
        std::uint32_t code = 0;
        for (unsigned i = 0; i < 4; ++i) code |= std::uint32_t{raw_[format::literal_byte0 + i][literal_]} << (8 * i);
        region = raw_[format::literal_regions][literal_++];
        if (region >= header.regions.size())
            fault("region of a literal", fmt::format("below {}", header.regions.size()), fmt::format("{}", region));
        element = recent_[region] += unzigzag(code);
    } else {
        fault("symbol", fmt::format("at most {}", format::literal), fmt::format("{}", symbol));
    }
    if (element >= header.regions[region].count)
        fault(fmt::format("element of region {}", region), fmt::format("below {}", header.regions[region].count),
              fmt::format("{}", element));
    pending_[lane] = element;
    schedule.waiting[region] |= bit;
}

void Decoder::decode_starts(const Header& header, Schedule& schedule, std::uint32_t mask) {
    const std::uint8_t* symbols = take(other_, other_end_, static_cast<unsigned>(std::popcount(mask)), "symbols");
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        stacks_[lane].clear();
        spelled(header, schedule, lane, 0, 0, *symbols++);
    }
}

/// `fixed_degree` is the degree of the record's region, known to the compiler; or `runtime`.
constexpr unsigned runtime = ~0u;

template <unsigned fixed_degree>
void Decoder::decode_access(const Header& header, Schedule& schedule, const Record& record, std::uint32_t* out) {
    const Region& region = header.regions[record.region];
    const unsigned degree = fixed_degree == runtime ? region.degree : fixed_degree;
    const std::uint32_t* table = region.links.data();
    const std::uint8_t* symbols = degree != 0 ? take(linked_, linked_end_, record.lanes(), "symbols")
                                              : take(other_, other_end_, record.lanes(), "symbols");
    const std::uint32_t high = std::uint32_t{record.region} << element_bits, last = region.count - 1;
    // The symbols that the loop below handles itself; the rest are spelled out.
    const unsigned spelled_from = format::sequential + (degree == 0 && record.region < unlinkable ? 1 : 0);
    SuccessorMasks masks;
    std::uint32_t followed = record.mask, sequential = 0, beyond = 0;
    for (std::uint32_t left = record.mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        const std::uint32_t bit = left & (0u - left);
        const std::uint32_t element = pending_[lane];
        *out++ = element;
        const std::uint8_t symbol = *symbols++;
        if (symbol >= spelled_from) [[unlikely]] {
            spelled(header, schedule, lane, record.region, element + 1, symbol);
            followed &= ~bit;
            continue;
        }
        LaneStack& stack = stacks_[lane];
        std::uint32_t word;
        if (degree == 0 && symbol == format::sequential) {
            word = (high | element) + 1;
            beyond |= element == last;
            sequential |= bit;
        } else {
            word = stack.follow(table + std::size_t{element} * degree, degree, symbol);
        }
        pending_[lane] = word & element_mask;
        masks.add(bit, word);
    }
    schedule.sequential |= sequential;
    if (beyond) fault("element", fmt::format("at most {}", last), "its successor");
    if (masks.spread(followed, schedule.waiting) != 0) fault("symbol", "an entry of the lane's stack", "none so deep");
}

void Decoder::decode_control(Schedule& schedule, Record& record) {
    std::uint8_t tag = 0;
    if (run_ == 0) {
        tag = control<std::uint8_t>("tag");
        if (tag == 0 || tag > format::tag_known)
            fault("tag", fmt::format("1 to {}", format::tag_known), fmt::format("{}", tag));
    } else {
        --run_;
    }
    record = {0, schedule.predicted_region(), schedule.ray, schedule.bounce, 0};
    if (tag & format::tag_region) record.region = control<std::uint8_t>("region");
    const std::uint32_t mask = tag & format::tag_mask ? control<std::uint32_t>("mask") : 0;
    if (tag & format::tag_ray) {
        const auto ray = control<std::uint8_t>("ray type");
        if (ray >= ray_types) fault("ray type", fmt::format("below {}", ray_types), fmt::format("{}", ray));
        record.ray = static_cast<RayType>(ray);
        record.bounce = control<std::uint8_t>("bounce");
    }
    if (!record.is_access()) {
        if (!(tag & format::tag_region)) fault("record", "lanes that wait", "none");
        if (mask == 0) fault("mask of a ray start", "at least one lane", "none");
        if (mask & schedule.busy()) fault("ray start", "lanes that have finished", "a lane that still waits");
        record.mask = mask;
        return;
    }
    if (tag & format::tag_mask) {
        const std::uint32_t waiting = schedule.waiting[record.region];
        if (mask & ~waiting) fault("lanes held back", "lanes that wait for the region", "others");
        record.mask = waiting & ~mask;
    } else {
        record.mask = schedule.predicted_mask(record.region);
    }
    if (record.mask == 0) fault("mask", "at least one lane", "none");
}

void Decoder::decode_warp(const Header& header, Schedule& schedule, WarpTrace& warp) {
    record_ = 0;
    const std::uint32_t records = control_varint("record count"), elements = control_varint("lane access count");
    if (records > records_left_ || elements > elements_left_)
        fault("counts of the warp", fmt::format("at most {} and {}", records_left_, elements_left_),
              fmt::format("{} and {}", records, elements));
    records_left_ -= records;
    elements_left_ -= elements;
    warp.records.resize(records);
    warp.elements.resize(elements);
    recent_.fill(0);
    for (LaneStack& stack : stacks_) stack.clear();
    schedule.start_warp();
    decode_starts(header, schedule, control_varint("lanes at the start"));

    std::uint32_t* out = warp.elements.data();
    std::uint32_t* const end = out + elements;
    run_ = 0;
    bool explicit_next = false;
    for (record_ = 0; record_ < records; ++record_) {
        if (run_ == 0 && !explicit_next) {
            run_ = control_varint("run of predicted records");
            explicit_next = true;
        }
        if (run_ == 0) explicit_next = false;
        Record& record = warp.records[record_];
        decode_control(schedule, record);
        schedule.begin(record);
        const unsigned count = record.lanes();
        if (!record.is_access()) {
            if (count > rays_left_) fault("rays", "no more than the block head says", "more");
            rays_left_ -= count;
            decode_starts(header, schedule, record.mask);
            continue;
        }
        if (count > static_cast<std::size_t>(end - out)) fault("lane accesses", "no more than the warp has", "more");
        switch (header.regions[record.region].degree) {
            case 0:
                decode_access<0>(header, schedule, record, out);
                break;
            case 2:
                decode_access<2>(header, schedule, record, out);
                break;
            case 4:
                decode_access<4>(header, schedule, record, out);
                break;
            case 8:
                decode_access<8>(header, schedule, record, out);
                break;
            default:
                decode_access<runtime>(header, schedule, record, out);
                break;
        }
        out += count;
    }
    if (run_ != 0) fault("run of predicted records", "no more than the warp has", "more");
    if (out != end) fault("lane accesses", "as many as the warp has", "fewer");
    if (schedule.busy() != 0) fault("end of the warp", "every lane finished", "a lane that waits");
    warp.issue.clear();
    if (header.issue) decode_issue(warp);
}

void Decoder::decode_issue(WarpTrace& warp) {
    const auto accesses = static_cast<std::uint32_t>(
        std::count_if(warp.records.begin(), warp.records.end(), [](const Record& r) { return r.is_access(); }));
    const std::uint32_t steps = control_varint("number of issue steps");
    if (steps > most_issue_steps(accesses))
        fault("issue steps", fmt::format("at most {}", most_issue_steps(accesses)), fmt::format("{}", steps));
    warp.issue.resize(steps);
    std::uint64_t access = 0;
    for (IssueStep& step : warp.issue) {
        access += control_varint("place of an issue step");
        const std::uint32_t back = control_varint("what an issue step waits for");
        if (access > accesses)
            fault("place of an issue step", fmt::format("at most {} accesses", accesses), fmt::format("{}", access));
        if (back > access) fault("what an issue step waits for", "an access before it", fmt::format("{} back", back));
        step.access = static_cast<std::uint32_t>(access);
        step.needs = back == 0 ? 0 : step.access - back + 1;
        step.instructions = control_varint("instructions of an issue step");
    }
    if (const char* what = issue_fault(warp.issue, accesses)) fault("issue steps", "the rules of the format", what);
}

/// Bytes that decoding the block takes, its warps included.
std::uint64_t memory_of(const BlockHead& head, bool issue) {
    std::uint64_t bytes = head.records * sizeof(Record) + head.lane_accesses * sizeof(std::uint32_t) +
                          std::uint64_t{head.warps} * sizeof(WarpTrace);
    for (const auto& size : head.sizes) bytes += size.raw;
    if (issue) bytes += (2 * head.records + head.warps) * sizeof(IssueStep);
    return bytes;
}

BlockHead Decoder::decode(const Header& header, std::span<const std::uint8_t> block, const Origin& origin,
                          const MemoryBudget& budget, std::vector<WarpTrace>& out) {
    const BlockHead head = parse_block_head(block, header.issue, origin);
    check_sealed(block, origin, "block", salvage);
    budget.check(memory_of(head, header.issue), origin.path, "records of a block");
    origin_ = origin;
    const std::uint8_t* stored = block.data() + format::block_head_bytes;
    for (unsigned s = 0; s < format::streams; ++s) {
        decompress({stored, head.sizes[s].stored}, head.sizes[s].raw,
                   origin + static_cast<std::uint64_t>(stored - block.data()), raw_[s]);
        stored += head.sizes[s].stored;
    }
    control_ = ByteReader(raw_[format::control]);
    linked_ = raw_[format::linked_symbols].data();
    linked_end_ = linked_ + raw_[format::linked_symbols].size();
    other_ = raw_[format::other_symbols].data();
    other_end_ = other_ + raw_[format::other_symbols].size();
    literal_ = 0;
    literals_ = raw_[format::literal_regions].size();
    records_left_ = head.records;
    elements_left_ = head.lane_accesses;
    rays_left_ = head.rays;

    out.resize(head.warps);
    Schedule schedule(header);
    for (warp_ = 0; warp_ < head.warps; ++warp_) {
        out[warp_].launch = head.launch;
        out[warp_].warp = static_cast<std::uint32_t>(head.first_warp + warp_);
        decode_warp(header, schedule, out[warp_]);
    }
    if (records_left_ != 0 || elements_left_ != 0 || rays_left_ != 0)
        refuse(origin, "counts of the block", "all of them used by its warps",
               fmt::format("{} records, {} lane accesses, {} rays left", records_left_, elements_left_, rays_left_));
    if (!control_.empty() || linked_ != linked_end_ || other_ != other_end_ || literal_ != literals_)
        refuse(origin, "streams of the block", "all of them used by its warps", "bytes left over");
    return head;
}

}  // namespace

BlockHead decode_block(const Header& header, std::span<const std::uint8_t> block, const Origin& origin,
                       const MemoryBudget& budget, std::vector<WarpTrace>& out) {
    thread_local const auto decoder = std::make_unique<Decoder>();
    return decoder->decode(header, block, origin, budget, out);
}

}  // namespace raycache::traces
