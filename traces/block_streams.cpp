#include "traces/block_streams.hpp"

#include "traces/compression.hpp"

namespace raycache::traces {

void BlockStreams::record(const Schedule& schedule, const Record& record) {
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

void BlockStreams::issue(const WarpTrace& warp) {
    append_varint(control_, static_cast<std::uint32_t>(warp.issue.size()));
    std::uint32_t access = 0;
    for (const IssueStep& step : warp.issue) {
        append_varint(control_, step.access - std::exchange(access, step.access));
        append_varint(control_, step.needs == 0 ? 0 : step.access - step.needs + 1);
        append_varint(control_, step.instructions);
    }
}

Bytes BlockStreams::assemble(BlockHead head) const {
    const auto until = [](const Bytes& buffer, const std::uint8_t* end) {
        return std::span(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
    };
    const std::array<std::span<const std::uint8_t>, format::streams> raw{control_,
                                                                         until(linked_, linked_end),
                                                                         until(other_, other_end),
                                                                         literals_[0],
                                                                         literals_[1],
                                                                         literals_[2],
                                                                         literals_[3],
                                                                         literals_[4]};
    Bytes bytes(format::block_head_bytes);
    for (unsigned s = 0; s < format::streams; ++s)
        head.sizes[s] = {
            static_cast<std::uint32_t>(raw[s].size()),
            static_cast<std::uint32_t>(compress(raw[s], s == format::control ? Effort::fast : Effort::entropy, bytes))};
    head.bytes = static_cast<std::uint32_t>(bytes.size() + format::checksum_bytes);
    store_block_head(head, bytes.data());
    seal(bytes);
    return bytes;
}

}  // namespace raycache::traces
