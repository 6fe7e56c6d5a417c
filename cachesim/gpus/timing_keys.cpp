#include "cachesim/gpus/key_tables.hpp"

namespace raycache::cachesim {

namespace {

/// Longest latency and most instructions; beyond, a unit is mistaken.
constexpr std::uint64_t longest = 100'000;
constexpr std::uint64_t most_mshrs = 65535;

}  // namespace

std::span<const Key<Timing>> timing_keys() {
    using T = Timing;
    static constexpr Key<T> keys[] = {
        {"not_predicted", text_or_none(&T::not_predicted), initial, "",
         "why no time is to be predicted. Reports then print that in place of times; traffic stays. The CPU preset has "
         "one; an empty text, `--set timing.not_predicted=''`, takes it away"},
        {"clock_mhz", real(&T::clock_mhz, 1, 1e5), needed, "MHz", "clock of the SMs"},
        {"launch_cycles", whole(&T::launch_cycles, 0, longest), initial, "cycles",
         "from a launch to its first instruction"},
        {"schedulers", whole(&T::schedulers, 1, 64), needed, "",
         "of an SM; each issues one instruction a cycle, for the warp slots that are its own, slot mod `schedulers`"},
        {"node_instructions", whole(&T::node_instructions, 0, longest), needed, "instructions",
         "between the loads of a visit to a node and the warp's next visit"},
        {"node4_instructions",
         whole(&T::node4_instructions, 0, longest),
         {false, "2.5 `node_instructions`",
          [](T& timing) { timing.node4_instructions = timing.node_instructions * 5 / 2; }},
         "instructions",
         "the same of a node of three or four children"},
        {"node8_instructions",
         whole(&T::node8_instructions, 0, longest),
         {false, "5 `node_instructions`", [](T& timing) { timing.node8_instructions = timing.node_instructions * 5; }},
         "instructions",
         "the same of a node of more children"},
        {"triangle_instructions", whole(&T::triangle_instructions, 0, longest), needed, "instructions",
         "the same of a triangle"},
        {"texel_instructions", whole(&T::texel_instructions, 0, longest), needed, "instructions",
         "the same of a texel"},
        {"leaf_instructions", whole(&T::leaf_instructions, 0, longest), initial, "instructions",
         "more, of a visit to triangles where lanes begin a leaf: one of them reads a triangle that a node of the "
         "trace "
         "links to ([MODEL.md](../cachesim/MODEL.md))"},
        {"shading_instructions", whole(&T::shading_instructions, 0, longest), initial, "instructions",
         "before lanes of a warp begin a ray"},
        {"instruction_latency", whole(&T::instruction_latency, 0, longest), needed, "cycles",
         "from an instruction to one that depends on it"},
        {"instruction_interval", whole(&T::instruction_interval, 1, 1000), initial, "cycles",
         "from an instruction to the next of the scheduler"},
        {"dependent_chains", whole(&T::dependent_chains, 1, 64), initial, "instructions",
         "of a visit, that may be under way at once"},
        {"accesses_in_flight", whole(&T::accesses_in_flight, 1, 64), initial, "",
         "visits of a warp that may be under way at once"},
        {"load_queue", whole(&T::load_queue, 1, 65535), initial, "loads",
         "of a scheduler, that may wait for the L1 port; not asked with `operand_collectors`"},
        {"operand_collectors", whole(&T::operand_collectors, 0, 32), initial, "",
         "collectors of a scheduler that loads and other instructions share, as in GPGPU-Sim; 0: none, `load_queue` "
         "counts. With them `l1_latency` is at least 4"},
        {"answers_per_cycle", whole(&T::answers_per_cycle, 0), initial, "",
         "look-ups whose sector came from below that an SM answers in a cycle; 0: any number"},
        {"l1_port", choice<&T::l1_port, l1_ports>(), initial, "", "how data leave L1; `banks`: GPGPU-Sim's rule"},
        {"l1_banks", power_of_two(&T::l1_banks, 1, 32), initial, "", "`banks`: a sector each and cycle"},
        {"tags_per_cycle", whole(&T::tags_per_cycle, 1, 64), initial, "lines", "`tags`: a cycle"},
        {"l1_bytes_per_cycle", real(&T::l1_bytes_per_cycle), initial, "bytes/cycle", "`tags`: of distinct sectors"},
        {"empty_request_cycles", whole(&T::empty_request_cycles, 0, 1000), initial, "cycles",
         "what a group of lanes without an active one takes of the port, where loads go in groups "
         "(`lanes_per_request_*` below 32); no one has published it. 0: such groups are left out"},
        {"l1_latency", whole(&T::l1_latency, 0, longest), needed, "cycles", "of a hit in L1"},
        {"l2_latency", whole(&T::l2_latency, 0, longest), needed, "cycles",
         "of a hit in L2, in an SM's own partition; no lower than `l1_latency`"},
        {"l2_far_latency",
         whole(&T::l2_far_latency, 0, longest),
         {false, "`l2_latency`", [](T& timing) { timing.l2_far_latency = timing.l2_latency; }},
         "cycles",
         "the same in another partition; differs from `l2_latency` if and only if there are several"},
        {"l3_latency",
         whole(&T::l3_latency, 0, longest),
         {false, "none"},
         "cycles",
         "of a hit in L3, where there is one, which needs it; no lower than `l2_latency`"},
        {"dram_latency", whole(&T::dram_latency, 0, longest), needed, "cycles",
         "of a miss in all levels, on average over all partitions; no lower than any of the above"},
        {"l2_partitions", whole(&T::l2_partitions, 1, 4096), initial, "",
         "an SM reaches its own after `l2_latency`, the others after `l2_far_latency`; at most as many as slices, 1 "
         "where there is an L3"},
        {"l1_mshrs", whole(&T::l1_mshrs, 1, most_mshrs), needed, "sectors", "under way, of an L1"},
        {"l1_mshr_merges", whole(&T::l1_mshr_merges, 1, most_mshrs), needed, "look-ups",
         "that a sector under way serves, the first included"},
        {"l2_mshrs", whole(&T::l2_mshrs, 1, most_mshrs), needed, "sectors",
         "under way, of an L2 slice; where there is an L3, of a core's L2"},
        {"l2_mshr_merges", whole(&T::l2_mshr_merges, 1, most_mshrs), needed, "look-ups", "as `l1_mshr_merges`"},
        {"l3_mshrs",
         whole(&T::l3_mshrs, 1, most_mshrs),
         {false, "none"},
         "sectors",
         "under way, of an L3 slice, where there is one, which needs it"},
        {"l3_mshr_merges",
         whole(&T::l3_mshr_merges, 1, most_mshrs),
         {false, "none"},
         "look-ups",
         "as `l1_mshr_merges`; an L3 needs it"},
        {"crossbar_bytes_per_cycle", real(&T::crossbar_bytes_per_cycle), needed, "bytes/cycle", "of an SM, each way"},
        {"crossbar_queues", choice<&T::crossbar_queues, crossbar_queues>(), initial, "",
         "`outputs`: packets wait for their output alone; `inputs`: behind others that wait for another"},
        {"l2_bytes_per_cycle", real(&T::l2_bytes_per_cycle), needed, "bytes/cycle", "of a slice"},
        {"l3_bytes_per_cycle", real(&T::l3_bytes_per_cycle), initial, "bytes/cycle", "of a slice"},
        {"dram_channels", whole(&T::dram_channels, 1, 4096), needed, "", "of the memory, with a queue each"},
        {"dram_gb_s", real(&T::dram_gb_s), needed, "GB/s", "10^9 bytes a second, of all channels together"},
        {"dram_bank_bits", list(&T::dram_bank_bits, "address bits", 10, 63), initial, "",
         "open rows: those that number a channel's banks; `dram_mhz` goes with them. `dram_latency` is then that of an "
         "open row"},
        {"dram_row_bit", whole(&T::dram_row_bit, 0, 63), initial, "", "open rows: lowest address bit of the row"},
        {"dram_mhz",
         real(&T::dram_mhz, 1, 1e5),
         {false, "none"},
         "MHz",
         "clock of DRAM; goes with `dram_bank_bits`, as all below"},
        {"dram_rcd", whole(&T::dram_rcd, 0, longest), initial, "DRAM cycles", "from opening a row to reading it"},
        {"dram_rp", whole(&T::dram_rp, 0, longest), initial, "DRAM cycles", "from closing a row to opening another"},
        {"dram_ras", whole(&T::dram_ras, 0, longest), initial, "DRAM cycles", "from opening a row to closing it"},
        {"dram_rc", whole(&T::dram_rc, 0, longest), initial, "DRAM cycles",
         "from opening a row to opening another of the bank"},
        {"dram_rrd", whole(&T::dram_rrd, 0, longest), initial, "DRAM cycles",
         "from opening a row to opening another of the channel"},
    };
    return keys;
}

}  // namespace raycache::cachesim
