// Which way of a set to evict from next, for caches that keep each line in the way that it took when it came.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

namespace raycache::cachesim {

class VictimOrder {
public:
    virtual ~VictimOrder() = default;
    /// A line in this way was looked up, or has just come.
    virtual void use(std::uint64_t set, std::uint64_t way) = 0;
    /// The way to evict from; all are full.
    virtual std::uint64_t victim(std::uint64_t set) = 0;
};

/// An Order as WaysInPlace takes it, behind that interface.
template <class Order>
class VictimOrderOf final : public VictimOrder {
public:
    template <class... Arguments>
    explicit VictimOrderOf(Arguments&&... arguments) : order_(std::forward<Arguments>(arguments)...) {}
    void use(std::uint64_t set, std::uint64_t way) override { order_.use(set, way); }
    std::uint64_t victim(std::uint64_t set) override { return order_.victim(set); }

private:
    Order order_;
};

}  // namespace raycache::cachesim
