#include "cachesim/replay/timed/warp_scheduler.hpp"

#include <bit>

namespace raycache::cachesim {

WarpScheduler::WarpScheduler(const Gpu& gpu)
    : load_queue_(gpu.timing->load_queue),
      interval_(gpu.timing->instruction_interval),
      chains_(gpu.timing->dependent_chains),
      round_(std::max(gpu.timing->instruction_latency, chains_ * interval_)),
      round_robin_(gpu.scheduler == Scheduler::loose_round_robin) {}

unsigned WarpScheduler::pick(std::uint64_t able) {
    if (round_robin_) {
        const std::uint64_t later = last_ == 63 ? 0 : able & (~std::uint64_t{0} << (last_ + 1));
        last_ = static_cast<unsigned>(std::countr_zero(later ? later : able));
        return last_;
    }
    if (able >> last_ & 1) return last_;
    last_ = static_cast<unsigned>(std::countr_zero(able));
    for (std::uint64_t left = able; left; left &= left - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(left));
        if (age_[bit] < age_[last_]) last_ = bit;
    }
    return last_;
}

Cycle WarpScheduler::run(Cycle time, std::uint32_t count, std::uint32_t early) {
    free_ = std::max(free_, time) + Cycle{count} * interval_;
    if (count == early) return time;
    const std::uint32_t left = count - early;
    const Cycle end = time + Cycle{(left - 1) / chains_} * round_ + (left - 1) % chains_ * interval_ + 1;
    return std::max(end, free_ - Cycle{early} * interval_);
}

}  // namespace raycache::cachesim
