// Which addresses objects of one size begin at: pages, and a bit for each place in them.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "traces/memory_budget.hpp"
#include "traces/page_table.hpp"

namespace raycache::traces {

/// Takes memory by what is read, not by how often: 8 bytes a page, and a bit for every `grain` bytes of it.
class AddressSet {
public:
    /// `grain`: a power of two up to 32 that divides every address.
    explicit AddressSet(std::uint32_t grain) : grain_(grain), words_(PageTable::page_bytes / grain / 64) {}

    void add(std::uint64_t address, MemoryBudget& budget, const std::string& file) {
        const std::uint64_t page = address >> PageTable::page_bits;
        if (page != page_ || bits_.empty()) {
            constexpr std::uint64_t of_map = 64;
            const auto [at, is_new] = pages_.try_emplace(page, pages_.size());
            if (is_new) {
                budget.charge(of_map + 2 * words_ * sizeof(std::uint64_t), file, "places of its loads");
                bits_.resize(bits_.size() + words_);
            }
            page_ = page;
            place_ = at->second * words_;
        }
        const std::uint64_t bit = address % PageTable::page_bytes / grain_;
        bits_[place_ + bit / 64] |= std::uint64_t{1} << bit % 64;
        together_ |= address;
    }

    std::uint64_t pages() const { return pages_.size(); }
    /// The largest power of two that divides all addresses, at most a page.
    std::uint32_t alignment() const {
        return static_cast<std::uint32_t>((together_ | PageTable::page_bytes) & -(together_ | PageTable::page_bytes));
    }
    /// Ascending.
    std::vector<std::uint64_t> page_numbers() const {
        std::vector<std::uint64_t> numbers;
        numbers.reserve(pages_.size());
        for (const auto& [number, place] : pages_) numbers.push_back(number);
        std::sort(numbers.begin(), numbers.end());
        return numbers;
    }

    /// Calls use(address), ascending.
    template <class Use>
    void each(const std::vector<std::uint64_t>& numbers, Use use) const {
        for (const std::uint64_t number : numbers) {
            const std::uint64_t* words = bits_.data() + pages_.at(number) * words_;
            for (std::uint64_t w = 0; w < words_; ++w)
                for (std::uint64_t left = words[w]; left != 0; left &= left - 1)
                    use((number << PageTable::page_bits) +
                        (w * 64 + static_cast<unsigned>(std::countr_zero(left))) * grain_);
        }
    }

private:
    std::uint64_t grain_, words_;  ///< words_: of a page
    std::unordered_map<std::uint64_t, std::uint64_t> pages_;
    std::vector<std::uint64_t> bits_;
    std::uint64_t page_ = 0, place_ = 0;  ///< the last one
    std::uint64_t together_ = 0;          ///< all addresses' bits
};

}  // namespace raycache::traces
