// Latencies and rates of a GPU: what a timed replay needs beside the geometry of its caches.
//
// Every resource is a server with a rate; a cycle is one of the SM's clock. Latencies are those that a lone dependent
// load sees from issue to issue (pointer chase), so each contains those of the levels above it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace raycache::cachesim {

/// How the data of one load leave L1.
enum class L1Port {
    /// Tags of tags_per_cycle lines and l1_bytes_per_cycle bytes of distinct sectors a cycle (NVIDIA since Volta).
    tags,
    /// l1_banks banks, a sector each and cycle, bank = sector number mod l1_banks; the sectors of a load go in
    /// descending order of address and wait for the next cycle at the first bank that is taken (GPGPU-Sim).
    banks,
};

/// Where packets wait for a crossbar.
enum class CrossbarQueues {
    outputs,  ///< each waits for its output alone
    inputs,   ///< in the order in which they came, behind others that wait for other outputs (GPGPU-Sim)
};

/// One level of caches.
struct LevelTiming {
    std::uint32_t latency = 0;                 ///< cycles, those of the levels above included
    std::uint32_t mshrs = 0, mshr_merges = 0;  ///< sectors under way, and look-ups that may wait for each; of a slice
    double bytes_per_cycle = 0;                ///< of each slice
};

struct Timing {
    /// Why the times that come out are not to be published; empty: they are. See no_time_note() in gpu.hpp.
    std::string not_predicted;
    double clock_mhz = 0;
    std::uint32_t launch_cycles = 0;  ///< from the launch to the first instruction
    std::uint32_t schedulers = 4;     ///< of an SM, each of one instruction a cycle; warp slot mod schedulers

    /// Instructions between the loads of a visit and the next access, by kind of object, and the cycles from one to the
    /// next that depends on it.
    std::uint32_t node_instructions = 0, triangle_instructions = 0, texel_instructions = 0;
    std::uint32_t node4_instructions = 0, node8_instructions = 0;  ///< of nodes of up to four, and more, children
    std::uint32_t leaf_instructions = 0;     ///< more, of a visit where lanes begin a leaf (timed/leaf_starts.hpp)
    std::uint32_t shading_instructions = 0;  ///< before lanes of a warp begin a ray: shading of the hit, set-up
    std::uint32_t instruction_latency = 4;
    std::uint32_t instruction_interval = 1;  ///< cycles between instructions issued by one scheduler
    std::uint32_t dependent_chains = 4;      ///< instructions of a visit in flight at once

    /// Visits of a warp that may be under way at once. Traversal needs what one visit brings for the next: 1.
    std::uint32_t accesses_in_flight = 1;
    std::uint32_t load_queue = 4;  ///< loads of a scheduler that may wait for the port of L1
    /// Collectors of a scheduler, which its loads and other instructions share (GPGPU-Sim). 0: none; loads wait as
    /// load_queue says, and hold up nothing else.
    std::uint32_t operand_collectors = 0;
    /// Look-ups whose sector came from below that an SM can answer; 0: any number.
    std::uint32_t answers_per_cycle = 0;

    L1Port l1_port = L1Port::tags;
    std::uint32_t l1_banks = 4;
    std::uint32_t tags_per_cycle = 4;
    double l1_bytes_per_cycle = 128;
    /// Where the lanes of a load go in several groups (FrontEnd::lanes_per_request_*): what one without an active lane
    /// takes of the port.
    std::uint32_t empty_request_cycles = 0;
    std::uint32_t l1_latency = 0, l2_latency = 0, l2_far_latency = 0;  ///< cycles
    std::uint32_t dram_latency = 0;                                    ///< on average over all partitions
    std::uint32_t l2_partitions = 1;  ///< an SM reaches its own after l2_latency, the others after l2_far_latency
    std::uint32_t l1_mshrs = 0, l1_mshr_merges = 0;  ///< sectors under way, and look-ups that may wait for each
    std::uint32_t l2_mshrs = 0, l2_mshr_merges = 0;  ///< of each slice
    double crossbar_bytes_per_cycle = 32;            ///< of each SM, each way
    CrossbarQueues crossbar_queues = CrossbarQueues::outputs;
    double l2_bytes_per_cycle = 32;                                  ///< of each slice
    std::uint32_t l3_latency = 0, l3_mshrs = 0, l3_mshr_merges = 0;  ///< where there is an L3: then L2 belongs to an SM
    double l3_bytes_per_cycle = 32;
    std::uint32_t dram_channels = 1;
    double dram_gb_s = 0;  ///< of all channels together, 10^9 bytes per second

    /// Open rows: the address bits that number the banks of a channel, and the lowest bit of the row. No bits: a read
    /// takes as long whatever is open. With bits dram_latency is that of an open row; those below are cycles of
    /// dram_mhz.
    std::vector<std::uint32_t> dram_bank_bits;
    std::uint32_t dram_row_bit = 0;
    double dram_mhz = 0;
    std::uint32_t dram_rcd = 0;  ///< from opening a row to reading it
    std::uint32_t dram_rp = 0;   ///< from closing a row to opening another
    std::uint32_t dram_ras = 0;  ///< from opening a row to closing it
    std::uint32_t dram_rc = 0;   ///< from opening a row to opening another of the bank
    std::uint32_t dram_rrd = 0;  ///< from opening a row to opening another of the channel

    /// L2 or L3: Gpu::levels[number].
    LevelTiming level(std::size_t number) const {
        return number == 1 ? LevelTiming{l2_latency, l2_mshrs, l2_mshr_merges, l2_bytes_per_cycle}
                           : LevelTiming{l3_latency, l3_mshrs, l3_mshr_merges, l3_bytes_per_cycle};
    }
    bool operator==(const Timing&) const = default;
};

}  // namespace raycache::cachesim
