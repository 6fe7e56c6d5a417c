#include "cachesim/replay/timed/memory_side.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::cachesim {

namespace {

/// Rates of this many times what is asked stand for no limit at all.
double cycles_per_sector(double bytes_per_cycle, std::uint32_t sector_bytes, bool infinite) {
    return infinite ? 0 : sector_bytes / bytes_per_cycle;
}

}  // namespace

MemorySide::MemorySide(const Gpu& gpu, const Idealised& ideal)
    : geometry_(gpu.levels.back()),
      timing_(*gpu.timing),
      perfect_(ideal.perfect_l2),
      map_(geometry_),
      tags_(geometry_.slices * geometry_.sets, geometry_.ways, geometry_.line_bytes / geometry_.sector_bytes,
            geometry_.policy == "fifo"),
      sectors_per_line_(geometry_.line_bytes / geometry_.sector_bytes),
      sectors_per_fill_(std::max(geometry_.fill_bytes, geometry_.sector_bytes) / geometry_.sector_bytes),
      sms_(gpu.sms),
      slices_per_channel_(std::max(1u, geometry_.slices / timing_.dram_channels)),
      shortest_(ideal.no_added_latency ? 0 : timing_.l2_latency - timing_.l1_latency),
      dram_extra_(ideal.no_added_latency ? 0 : timing_.dram_latency - timing_.l2_latency),
      far_extra_(ideal.no_added_latency ? 0 : timing_.l2_far_latency - timing_.l2_latency),
      crossbar_cost_(
          cycles_per_sector(timing_.crossbar_bytes_per_cycle, geometry_.sector_bytes, ideal.infinite_bandwidth)),
      slice_cost_(cycles_per_sector(timing_.l2_bytes_per_cycle, geometry_.sector_bytes, ideal.infinite_bandwidth)),
      dram_cost_(cycles_per_sector(timing_.dram_gb_s * 1e9 / (timing_.clock_mhz * 1e6) / timing_.dram_channels,
                                   geometry_.sector_bytes, ideal.infinite_bandwidth)),
      channel_(timing_.dram_channels),
      under_way_(geometry_.slices),
      to_slices_(gpu.sms, geometry_.slices, slice_cost_),
      to_sms_(geometry_.slices, gpu.sms, crossbar_cost_),
      sent_(gpu.sms) {
    std::size_t entries = geometry_.slices * geometry_.sets * geometry_.ways;
    if (auto buffer = make_fill_buffer(geometry_, timing_.l2_mshrs)) {
        entries += std::size_t{geometry_.slices} * buffer->lines();
        fills_.assign(geometry_.slices, *buffer);
    }
    merges_.resize(entries * sectors_per_line_);
}

void MemorySide::request(const MissRequest& miss) {
    double& free = sent_[miss.sm];
    const double sent = std::max(static_cast<double>(miss.time), free);
    free = sent + crossbar_cost_;
    to_slices_.add(miss.sm, {static_cast<Cycle>(std::ceil(sent)), map_.place(miss.line).slice, miss});
}

void MemorySide::run_requests(Cycle end) {
    to_slices_.run(end, [this](const Packet& packet, Cycle time) { serve(packet, time); });
}

void MemorySide::serve(const Packet& packet, Cycle time) {
    const MissRequest& miss = packet.miss;
    const Cycle arrival = look_up(miss.line, miss.sector, packet.output, time);
    const bool far = std::uint64_t{packet.output} * timing_.l2_partitions / geometry_.slices !=
                     std::uint64_t{miss.sm} * timing_.l2_partitions / sms_;
    const Cycle ready = std::max(arrival, time) + shortest_ + (far ? far_extra_ : 0);
    to_sms_.add(packet.output, {ready, miss.sm, miss.entry, miss.sector, miss.l1});
}

Cycle MemorySide::look_up(std::uint64_t line, std::uint32_t sector, std::uint32_t slice, Cycle time) {
    if (perfect_) {
        ++answers_.hits;
        return time;
    }
    FillBuffer* const fills = fills_.empty() ? nullptr : &fills_[slice];
    if (fills) fills->drain(time, tags_, map_);
    std::uint32_t entry = tags_.find(line);
    const auto merge = [&](std::uint32_t number, Cycle arrival) {
        ++answers_.merges;
        // A register that merges no more holds up the slice until the data are there.
        if (++merges_[number * sectors_per_line_ + sector] >= timing_.l2_mshr_merges)
            to_slices_.block_output(slice, arrival);
        return arrival;
    };
    if (entry != SectorTags::none && tags_.present(entry, sector)) {
        tags_.use(entry);
        const Cycle arrival = tags_.arrival(entry, sector);
        if (arrival > time) return merge(entry, arrival);
        ++answers_.hits;
        return time;
    }
    if (fills) {
        const std::uint32_t filling = fills->find(line, sector);
        if (filling != SectorTags::none) return merge(first_fill(slice) + filling, fills->arrival(filling, sector));
    }
    auto& under_way = under_way_[slice];
    while (!under_way.empty() && under_way.top() <= time) under_way.pop();
    const auto wait = [&] {  // until a register is free
        time = under_way.empty() ? time + 1 : std::max(time + 1, under_way.top());
        if (!under_way.empty()) under_way.pop();
        if (!fills) return;
        fills->drain(time, tags_, map_);
        entry = tags_.find(line);
    };
    if (under_way.size() >= timing_.l2_mshrs) {
        wait();
        to_slices_.block_output(slice, time);
    }
    if (entry != SectorTags::none) {
        ++answers_.sector_misses;
        tags_.use(entry);
    } else {
        ++answers_.line_misses;
        const std::uint64_t set = map_(line);
        while (!fills && (entry = tags_.replace(set, line, time)) == SectorTags::none) wait();  // no line has arrived
    }
    const std::uint32_t first = sector / sectors_per_fill_ * sectors_per_fill_;
    Cycle arrival = 0;
    for (std::uint32_t s = first; s < first + sectors_per_fill_; ++s) {
        if (entry != SectorTags::none && tags_.present(entry, s)) continue;
        if (fills && fills->find(line, s) != SectorTags::none) continue;
        const Cycle here = read_dram(slice, time);
        std::uint32_t holder = entry;
        if (fills) {
            while ((holder = fills->add(line, s, here, time)) == SectorTags::none) wait();
            holder += first_fill(slice);
        } else {
            tags_.add(entry, s, here);
        }
        merges_[holder * sectors_per_line_ + s] = 1;
        under_way.push(here);
        if (s == sector) arrival = here;
    }
    return arrival;
}

Cycle MemorySide::read_dram(std::uint32_t slice, Cycle time) {
    ++dram_sectors_;
    double& free = channel_[slice / slices_per_channel_ % timing_.dram_channels];
    const double start = std::max(static_cast<double>(time), free);
    free = start + dram_cost_;
    return static_cast<Cycle>(std::ceil(start)) + dram_extra_;
}

}  // namespace raycache::cachesim
