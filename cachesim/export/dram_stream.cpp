#include "cachesim/export/dram_stream.hpp"

#include <fmt/format.h>

#include <iterator>
#include <utility>

namespace raycache::cachesim {

namespace {

constexpr std::size_t dram_piece_bytes = std::size_t{1} << 16;

void append_ramulator(const DramRequest& r, std::string& out) {
    fmt::format_to(std::back_inserter(out), "0x{:x} {}\n", r.address, r.write ? 'W' : 'R');
}

void append_ramulator2(const DramRequest& r, std::string& out) {
    fmt::format_to(std::back_inserter(out), "{} 0x{:x}\n", r.write ? "ST" : "LD", r.address);
}

void append_dramsim3(const DramRequest& r, std::string& out) {
    fmt::format_to(std::back_inserter(out), "0x{:x} {} {}\n", r.address, r.write ? "WRITE" : "READ", r.cycle);
}

}  // namespace

const std::vector<DramFormat>& dram_formats() {
    static const std::vector<DramFormat> formats{
        {"ramulator", "Ramulator's memory traces: \"0xADDRESS R\" or W", append_ramulator},
        {"ramulator2", "Ramulator 2's LoadStoreTrace: \"LD 0xADDRESS\" or ST", append_ramulator2},
        {"dramsim3", "DRAMsim3's traces: \"0xADDRESS READ CYCLE\" or WRITE", append_dramsim3, true}};
    return formats;
}

DramStream::DramStream(const DramFormat& format, double clock_ratio, std::function<void(std::string_view)> write)
    : format_(format), clock_ratio_(clock_ratio), write_(std::move(write)) {}

void DramStream::add(std::uint64_t address, bool is_write, Cycle cycle) {
    ++(is_write ? writes_ : reads_);
    waiting_.push({{address, is_write, cycle}, reads_ + writes_});
}

void DramStream::reached(Cycle cycle) {
    while (!waiting_.empty() && waiting_.top().request.cycle < cycle) write_first();
}

void DramStream::write_first() {
    DramRequest request = waiting_.top().request;
    waiting_.pop();
    request.cycle = static_cast<Cycle>(static_cast<double>(request.cycle) * clock_ratio_);
    format_.append(request, pending_);
    if (pending_.size() >= dram_piece_bytes) hand_over();
}

void DramStream::flush() {
    while (!waiting_.empty()) write_first();
    hand_over();
}

void DramStream::hand_over() {
    write_(pending_);
    pending_.clear();
}

}  // namespace raycache::cachesim
