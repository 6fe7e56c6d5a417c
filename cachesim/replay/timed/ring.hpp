// A queue that keeps its memory.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace raycache::cachesim {

template <class T>
class Ring {
public:
    bool empty() const { return begin_ == end_; }
    std::size_t size() const { return end_ - begin_; }
    T& front() { return items_[begin_ & mask()]; }
    const T& front() const { return items_[begin_ & mask()]; }
    /// From the front.
    T& operator[](std::size_t i) { return items_[(begin_ + i) & mask()]; }

    void push(T item) {
        if (size() == items_.size()) grow();
        items_[end_++ & mask()] = std::move(item);
    }
    void pop() { ++begin_; }

    /// Pushes, then moves the item before those that it is `before`: few, if items mostly come in order.
    template <class Before>
    void insert(T item, const Before& before) {
        push(std::move(item));
        for (std::size_t i = end_ - 1; i != begin_ && before(items_[i & mask()], items_[(i - 1) & mask()]); --i)
            std::swap(items_[i & mask()], items_[(i - 1) & mask()]);
    }

private:
    std::size_t mask() const { return items_.size() - 1; }
    void grow() {
        std::vector<T> more(items_.empty() ? 16 : 2 * items_.size());
        const std::size_t count = size();
        for (std::size_t i = 0; i < count; ++i) more[i] = std::move((*this)[i]);
        items_ = std::move(more);
        begin_ = 0;
        end_ = count;
    }

    std::vector<T> items_;  ///< a power of two of places
    std::size_t begin_ = 0, end_ = 0;
};

}  // namespace raycache::cachesim
