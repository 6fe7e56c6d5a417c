// The pages of memory that a region with gaps lies in.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace raycache::traces {

/// Pages of 2^page_bits bytes, ascending. Copies share them.
class PageTable {
public:
    static constexpr unsigned page_bits = 12;
    static constexpr std::uint64_t page_bytes = std::uint64_t{1} << page_bits;

    PageTable() = default;
    /// `numbers`: of the pages (address / page_bytes), strictly ascending.
    explicit PageTable(std::vector<std::uint64_t> numbers)
        : numbers_(std::make_shared<const std::vector<std::uint64_t>>(std::move(numbers))) {}

    bool empty() const { return !numbers_ || numbers_->empty(); }
    std::uint64_t count() const { return numbers_ ? numbers_->size() : 0; }
    const std::vector<std::uint64_t>& numbers() const {
        static const std::vector<std::uint64_t> none;
        return numbers_ ? *numbers_ : none;
    }

    /// Of byte `byte` of the pages in a row, which they must have.
    std::uint64_t address(std::uint64_t byte) const {
        return ((*numbers_)[byte >> page_bits] << page_bits) + byte % page_bytes;
    }

    bool operator==(const PageTable& other) const { return numbers() == other.numbers(); }

private:
    std::shared_ptr<const std::vector<std::uint64_t>> numbers_;
};

}  // namespace raycache::traces
