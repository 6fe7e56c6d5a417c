#include "cachesim/replay/group_numbers.hpp"

namespace raycache::cachesim {

std::uint32_t BatchGroups::add(traces::RayType ray, std::uint8_t bounce) {
    const std::lock_guard lock(all_.mutex_);
    std::atomic<std::uint32_t>& first = first_[place(ray, bounce)];
    if (const std::uint32_t there = first.load(std::memory_order_relaxed); there != absent) return there;
    const auto number = static_cast<std::uint32_t>(all_.rays_.size() * all_.per_ray_);
    all_.rays_.push_back({ray, bounce, batch_});
    all_.size_.store(all_.rays_.size() * all_.per_ray_, std::memory_order_release);
    first.store(number, std::memory_order_release);
    return number;
}

}  // namespace raycache::cachesim
