#include "cachesim/replay/timed/memory_side.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::cachesim {

namespace {

/// Rates of this many times what is asked stand for no limit at all.
double cycles_per_sector(double bytes_per_cycle, std::uint32_t sector_bytes, bool infinite) {
    return infinite ? 0 : sector_bytes / bytes_per_cycle;
}

/// What a far partition adds.
Cycle far_extra(const TimedRules& rules) {
    if (rules.ideal.no_added_latency || rules.three_levels()) return 0;
    return rules.timing.l2_far_latency - rules.timing.l2_latency;
}

/// Of a read beyond the last level. The latency of DRAM is an average over near and far partitions.
Cycle dram_extra(const TimedRules& rules, Cycle level_latency) {
    if (rules.ideal.no_added_latency) return 0;
    const Cycle partitions = rules.timing.l2_partitions, extra = rules.timing.dram_latency - level_latency;
    return extra - std::min(extra, far_extra(rules) * (partitions - 1) / partitions);
}

}  // namespace

MemorySide::MemorySide(const TimedRules& rules)
    : rules_(rules),
      timing_(rules.timing.level(rules.gpu.levels.size() - 1)),
      slice_count_(rules.gpu.levels.back().slices),
      sectors_per_fill_(std::max(rules.gpu.levels.back().fill_bytes, rules.gpu.l1().sector_bytes) /
                        rules.gpu.l1().sector_bytes),
      by_inputs_(rules.timing.crossbar_queues == CrossbarQueues::inputs),
      level_extra_(rules.ideal.no_added_latency ? 0 : timing_.latency - rules.timing.l1_latency),
      far_extra_(far_extra(rules)),
      window_(std::max<Cycle>(1, level_extra_)),
      crossbar_cost_(cycles_per_sector(rules.timing.crossbar_bytes_per_cycle, rules.gpu.l1().sector_bytes,
                                       rules.ideal.infinite_bandwidth)),
      slice_cost_(
          cycles_per_sector(timing_.bytes_per_cycle, rules.gpu.l1().sector_bytes, rules.ideal.infinite_bandwidth)),
      dram_(
          rules.timing,
          cycles_per_sector(rules.timing.dram_gb_s * 1e9 / (rules.timing.clock_mhz * 1e6) / rules.timing.dram_channels,
                            rules.gpu.l1().sector_bytes, rules.ideal.infinite_bandwidth),
          dram_extra(rules, timing_.latency)),
      to_slices_(by_inputs_ ? rules.gpu.sms : slice_count_, slice_count_, slice_cost_, window_),
      to_sms_(by_inputs_ ? slice_count_ : rules.gpu.sms, rules.gpu.sms, crossbar_cost_, window_),
      sent_(rules.gpu.sms),
      slice_free_(slice_count_) {
    CacheGeometry slice = rules.gpu.levels.back();
    slice.slices = 1;
    for (std::uint32_t i = 0; i < slice_count_; ++i) slices_.emplace_back(slice, i, timing_.mshrs);
}

void MemorySide::request(const MissRequest& miss) {
    double& free = sent_[miss.sm];
    const double sent = std::max(static_cast<double>(miss.time), free);
    free = sent + crossbar_cost_;
    const LineMap::Place place = rules_.maps.back().place(miss.line);
    slices_[place.slice].lines().prefetch(miss.id);  // it is looked up when the requests of all SMs are there
    to_slices_.add(by_inputs_ ? miss.sm : place.slice,
                   {static_cast<Cycle>(std::ceil(sent)), place.slice, static_cast<std::uint32_t>(place.set), miss.id,
                    miss.number, miss.sm, miss.sector, miss.l1});
}

void MemorySide::run_requests(Cycle begin, Cycle end) {
    if (sink_) sink_->reached(begin);
    to_slices_.run(begin, end, [this](const Packet& packet, double arrived) { serve(packet, arrived); });
}

void MemorySide::serve(const Packet& packet, double arrived) {
    double& free = slice_free_[packet.output];
    const double start = std::max(arrived, free);
    free = start + slice_cost_;
    const auto time = static_cast<Cycle>(std::ceil(start));
    const Cycle arrival = look_up(packet, time);
    Cycle ready = std::max(arrival, time) + level_extra_;
    if (far_extra_ != 0) {
        const std::uint64_t partitions = rules_.timing.l2_partitions;
        if (packet.output * partitions / slice_count_ != packet.sm * partitions / rules_.gpu.sms) ready += far_extra_;
    }
    to_sms_.add(by_inputs_ ? packet.output : packet.sm, {ready, packet.sm, packet.number, packet.l1});
}

/// When the sector is in its slice.
Cycle MemorySide::look_up(const Packet& packet, Cycle time) {
    if (rules_.ideal.perfect_l2) {
        ++answers_.hits;
        return time;
    }
    TimedCache& slice = slices_[packet.output];
    SectorCache& lines = slice.lines();
    MissRegisters& registers = slice.registers();
    slice.drain(time);
    std::uint32_t entry = lines.find(packet.id);
    if (entry != TimedCache::none && (lines[entry].present >> packet.sector & 1)) {
        lines.use(entry);
        ++answers_.hits;
        return time;
    }
    if (const std::uint32_t pending = slice.find_pending(packet.id, packet.sector, entry);
        pending != TimedCache::none) {
        MissRegisters::Register& r = registers[pending];
        if (r.merged < timing_.mshr_merges) {
            if (entry != TimedCache::none) lines.use(entry);
            ++r.merged;
            ++answers_.merges;
            return r.arrival;
        }
        time = r.arrival;
        hold_up(packet.output, time);
        slice.drain(time);
        lines.use(lines.find(packet.id));
        ++answers_.hits;
        return time;
    }
    const auto wait = [&] {  // until a register is free
        time = std::max(time + 1, slice.next_arrival() == never ? 0 : slice.next_arrival());
        slice.drain(time);
        entry = lines.find(packet.id);
    };
    if (registers.full()) {
        wait();
        hold_up(packet.output, time);
    }
    if (entry != TimedCache::none) {
        ++answers_.sector_misses;
        lines.use(entry);
    } else {
        ++answers_.line_misses;
    }
    const std::uint32_t first = packet.sector / sectors_per_fill_ * sectors_per_fill_;
    Cycle arrival = 0;
    for (std::uint32_t s = first; s < first + sectors_per_fill_; ++s) {
        if (entry != TimedCache::none && (lines[entry].present >> s & 1)) continue;
        if (slice.find_pending(packet.id, s, entry) != TimedCache::none) continue;
        while (registers.full()) wait();
        // Room is made before DRAM is asked: a line whose sectors are all on their way holds up the slice.
        std::uint32_t number = TimedCache::none;
        while ((number = slice.send_for(packet.id, s, packet.set, entry, time)) == TimedCache::none) wait();
        const Cycle here = read_dram(packet, s, time);
        waiting_ += slice.set_arrival(number, here);
        if (s == packet.sector) arrival = here;
    }
    return arrival;
}

std::size_t MemorySide::channel_of(const Packet& packet) const {
    const auto channels = static_cast<std::uint32_t>(dram_.channels());
    if (slice_count_ % channels == 0) return packet.output / (slice_count_ / channels);
    // The set tells lines of a slice apart; its neighbours go to other channels.
    if (channels % slice_count_ == 0)
        return packet.output * (channels / slice_count_) + packet.set % (channels / slice_count_);
    return (packet.output + std::uint64_t{packet.set} * slice_count_) % channels;
}

Cycle MemorySide::read_dram(const Packet& packet, std::uint32_t sector, Cycle time) {
    ++dram_sectors_;
    if (sink_) [[unlikely]]
        sink_->read(rules_.ids.line(packet.id) * rules_.gpu.l1().line_bytes +
                        std::uint64_t{sector} * rules_.gpu.l1().sector_bytes,
                    time);
    const std::uint64_t line = dram_.has_rows() ? rules_.ids.line(packet.id) : 0;
    return dram_.read(channel_of(packet), line * rules_.gpu.l1().line_bytes, time);
}

}  // namespace raycache::cachesim
