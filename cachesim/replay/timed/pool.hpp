// Places for things that come and go, by number: those given back are taken again first.
#pragma once

#include <cstdint>
#include <vector>

namespace raycache::cachesim {

/// `Item` has a member `next`, which belongs to the pool while the item is not taken.
template <class Item>
class Pool {
public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    Item& operator[](std::uint32_t number) { return items_[number]; }
    const Item& operator[](std::uint32_t number) const { return items_[number]; }

    /// Returns its number.
    std::uint32_t take(const Item& item) {
        const std::uint32_t number = free_;
        if (number == none) {
            items_.push_back(item);
            return static_cast<std::uint32_t>(items_.size() - 1);
        }
        free_ = items_[number].next;
        items_[number] = item;
        return number;
    }

    /// Those from `first` to `last`, each linked to the next.
    void give_back(std::uint32_t first, std::uint32_t last) {
        items_[last].next = free_;
        free_ = first;
    }
    void give_back(std::uint32_t number) { give_back(number, number); }

private:
    std::vector<Item> items_;  ///< all that were ever taken
    std::uint32_t free_ = none;
};

}  // namespace raycache::cachesim
