// Whom a warp access is charged to: a number for every (batch, ray type, bounce, region) that occurs.
//
// A batch is what statistics are kept for: the warps between "count from here" and "count until here". Its groups are
// numbered when they first occur, so tallies are arrays without holes. SMs on different threads may ask at once; which
// of them gets which number then depends on time, the counts do not.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "traces/record.hpp"

namespace raycache::cachesim {

class GroupNumbers;

/// The groups of one batch.
class BatchGroups {
public:
    static constexpr std::uint32_t absent = ~std::uint32_t{0};

    /// `batch`: from 0 on, or not_counted.
    BatchGroups(GroupNumbers& all, std::uint32_t batch) : all_(all), batch_(batch) {
        for (auto& first : first_) first.store(absent, std::memory_order_relaxed);
    }

    std::uint32_t batch() const { return batch_; }

    /// Of the record's ray type, which must be known, and bounce: one group for each region from this number on, and
    /// one behind them for ray starts.
    std::uint32_t first(const traces::Record& record) {
        const std::uint32_t first = first_[place(record.ray, record.bounce)].load(std::memory_order_acquire);
        return first != absent ? first : add(record.ray, record.bounce);
    }
    /// Likewise; `absent` if none has asked for it.
    std::uint32_t find(traces::RayType ray, unsigned bounce) const {
        return first_[place(ray, bounce)].load(std::memory_order_acquire);
    }

private:
    static std::size_t place(traces::RayType ray, unsigned bounce) {
        return static_cast<std::size_t>(ray) * (traces::max_bounce + 1) + bounce;
    }
    std::uint32_t add(traces::RayType, std::uint8_t bounce);

    GroupNumbers& all_;
    std::uint32_t batch_;
    std::array<std::atomic<std::uint32_t>, traces::ray_types*(traces::max_bounce + 1)> first_;
};

/// The batch of accesses that no statistics are kept for.
inline constexpr std::uint32_t not_counted = ~std::uint32_t{0};

class GroupNumbers {
public:
    explicit GroupNumbers(std::size_t regions) : per_ray_(regions + 1) {}
    GroupNumbers(const GroupNumbers&) = delete;
    GroupNumbers& operator=(const GroupNumbers&) = delete;

    /// The next batch. References stay valid. Not while SMs run.
    BatchGroups& begin_batch() { return batches_.emplace_back(*this, static_cast<std::uint32_t>(batches_.size())); }
    BatchGroups& last_batch() { return batches_.back(); }
    BatchGroups& uncounted() { return uncounted_; }
    const std::deque<BatchGroups>& batches() const { return batches_; }

    /// Groups of one ray type and bounce of a batch.
    std::size_t per_ray() const { return per_ray_; }

    /// Groups so far.
    std::size_t size() const { return size_.load(std::memory_order_acquire); }

    struct RayOf {
        traces::RayType ray{};
        std::uint8_t bounce = 0;
        std::uint32_t batch = 0;
    };
    /// Of a group. Not while another thread numbers any.
    const RayOf& ray_of(std::uint32_t group) const { return rays_[group / per_ray_]; }

private:
    friend class BatchGroups;

    std::size_t per_ray_;
    std::deque<BatchGroups> batches_;
    BatchGroups uncounted_{*this, not_counted};
    std::mutex mutex_;         ///< of rays_, and of what is stored in BatchGroups
    std::vector<RayOf> rays_;  ///< of each per_ray_ groups
    std::atomic<std::size_t> size_ = 0;
};

}  // namespace raycache::cachesim
