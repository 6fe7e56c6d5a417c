// Writes what DRAM is asked for in a timed replay as a request file of DRAM simulators, a sector a line.
//
// Formats, after the sources of the simulators that read them: Ramulator (src/Processor.cpp, Trace::get_request of the
// memory-trace mode: address in hexadecimal, R or W), Ramulator 2 (frontend/impl/memory_trace/loadstore_trace.cpp: LD
// or ST, address) and DRAMsim3 (src/common.cc, operator>> of Transaction: address in hexadecimal, READ or WRITE, cycle;
// src/cpu.cc waits for that cycle). Only the last has a place for time; the order is that of time in all.
#pragma once

#include <cstdint>
#include <functional>
#include <queue>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/replay/timed/dram_sink.hpp"

namespace raycache::cachesim {

struct DramRequest {
    std::uint64_t address = 0;  ///< of the sector's first byte
    bool write = false;
    Cycle cycle = 0;
};

struct DramFormat {
    std::string name, description;
    void (*append)(const DramRequest&, std::string& out);
    bool has_cycles = false;
};

/// ramulator, ramulator2, dramsim3.
const std::vector<DramFormat>& dram_formats();

class DramStream final : public DramSink {
public:
    /// `clock_ratio`: cycles of the file for one of the SMs; they are rounded down. `write` gets the lines in pieces of
    /// about 64 KiB, in order of their cycles, those of one cycle in the order in which they were asked for.
    DramStream(const DramFormat&, double clock_ratio, std::function<void(std::string_view)> write);

    void read(std::uint64_t address, Cycle cycle) override { add(address, false, cycle); }
    void write(std::uint64_t address, Cycle cycle) override { add(address, true, cycle); }
    void moved(std::uint64_t sectors) override { moved_ += sectors; }
    void reached(Cycle) override;

    /// Writes what is left. Call after TimedReplay::finish().
    void flush();

    std::uint64_t reads() const { return reads_; }
    std::uint64_t writes() const { return writes_; }
    /// Sectors that sorts move, which are in no line.
    std::uint64_t sorted() const { return moved_; }

private:
    struct Waiting {
        DramRequest request;
        std::uint64_t number = 0;
        bool operator>(const Waiting& other) const {
            return request.cycle != other.request.cycle ? request.cycle > other.request.cycle : number > other.number;
        }
    };
    void add(std::uint64_t address, bool is_write, Cycle);
    void write_first();
    void hand_over();

    const DramFormat& format_;
    double clock_ratio_;
    std::function<void(std::string_view)> write_;
    /// Not written yet: one of an earlier cycle may come.
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
    std::uint64_t reads_ = 0, writes_ = 0, moved_ = 0;
    std::string pending_;
};

}  // namespace raycache::cachesim
