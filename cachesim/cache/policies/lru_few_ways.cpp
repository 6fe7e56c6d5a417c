#include "cachesim/cache/policies/lru_few_ways.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "cachesim/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/cache/policies/lru_few_ways.cpp"
#include <hwy/foreach_target.h>

#include "cachesim/vector_ops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {
namespace {

/// An empty way is the word 0: line 0 without sectors.
template <unsigned vectors>
class LruFewWays final : public Level {
public:
    LruFewWays(const CacheGeometry& geometry, unsigned caches)
        : fill_(geometry),
          near_(geometry.slices * geometry.sets * sizeof(Set) <= near),
          oldest_(std::uint64_t{1} << (geometry.ways - 1)),
          sector_bits_(geometry.line_bytes / geometry.sector_bytes),
          sets_(geometry.slices * geometry.sets * caches) {}

    void process(const std::uint32_t* sets, const std::uint32_t* lines, std::uint32_t* sectors,
                 std::size_t count) override {
        counts_ ? look_up<true>(sets, lines, sectors, count) : look_up<false>(sets, lines, sectors, count);
    }

    void count_fills() override { counts_ = true; }
    LineFills fills() const override { return fills_; }

private:
    /// A cache of so many bytes of words stays in the L1 of the machine while its look-ups last.
    static constexpr std::size_t near = 16384;

    struct alignas(std::min<std::size_t>(64, std::bit_ceil(vectors* lanes_of_vector * 4u))) Set {
        std::uint32_t words[vectors * lanes_of_vector] = {};
    };

    template <bool counts>
    void look_up(const std::uint32_t* sets, const std::uint32_t* lines, std::uint32_t* sectors, std::size_t count) {
        LineFills fills;
        if (near_) {
            for (std::size_t i = 0; i < count; ++i)
                sectors[i] = fetch<counts>(sets_[sets[i]], lines[i], sectors[i], fills);
        } else {
            constexpr std::size_t ahead = 32;  // so that their memory is on its way
            for (std::size_t i = 0; i < std::min(ahead, count); ++i) prefetch(sets[i]);
            for (std::size_t i = 0; i < count; ++i) {
                prefetch(sets[std::min(i + ahead, count - 1)]);
                sectors[i] = fetch<counts>(sets_[sets[i]], lines[i], sectors[i], fills);
            }
        }
        fills_ += fills;
    }

    void prefetch(std::uint32_t set) const {
        for (std::size_t byte = 0; byte < sizeof(Set); byte += 64)
            __builtin_prefetch(reinterpret_cast<const char*>(&sets_[set]) + byte, 1);
    }

    /// The missing sectors and what Fill adds.
    template <bool counts>
    HWY_INLINE std::uint32_t fetch(Set& set, std::uint32_t line, std::uint32_t wanted, LineFills& fills) const {
        const std::uint32_t missing = access<counts>(set, line, wanted, fills);
        if (!fill_.widens() || !missing) return missing;
        return missing | access<counts>(set, line, fill_.pieces(missing), fills);
    }

    template <bool counts>
    HWY_INLINE std::uint32_t access(Set& set, std::uint32_t line, std::uint32_t sectors, LineFills& fills) const {
        const std::uint32_t sector_mask = (1u << sector_bits_) - 1;
        const std::uint32_t tag = line << sector_bits_;
        const Vector tag_mask = all(~sector_mask), wanted = all(tag);
        Vector words[vectors];
        std::uint64_t candidates = oldest_;  // if the line is in no way, it takes the oldest
        for (unsigned v = 0; v < vectors; ++v) {
            words[v] = hn::Load(words_tag, &set.words[v * lanes_of_vector]);
            candidates |= std::uint64_t{bits_of(hn::Eq(hn::And(words[v], tag_mask), wanted))} << (v * lanes_of_vector);
        }
        const auto place = static_cast<std::uint32_t>(std::countr_zero(candidates));
        // Whether the tag is equal cannot be predicted, so it becomes a mask: only 0 - 1 is negative.
        const std::uint32_t difference = set.words[place] ^ tag;
        const auto equal = static_cast<std::int32_t>((difference >> sector_bits_) - 1) >> 31;
        const std::uint32_t present = difference & static_cast<std::uint32_t>(equal);
        if constexpr (counts) {
            fills.line_misses += present == 0;  // a line that is there has sectors
            fills.of_empty_ways += set.words[place] == 0;
        }
        Vector before = all(tag | present | sectors);
        const auto last = hn::BitCast(hn::RebindToSigned<Words>(), all(place));  // this way and all newer ones move
        for (unsigned v = 0; v < vectors; ++v) {
            const auto ways = hn::Iota(hn::RebindToSigned<Words>(), static_cast<std::int32_t>(v * lanes_of_vector));
            const auto stays = hn::RebindMask(words_tag, hn::Gt(ways, last));
            hn::Store(hn::IfThenElse(stays, words[v], moved_up(words[v], before)), words_tag,
                      &set.words[v * lanes_of_vector]);
            before = words[v];
        }
        return sectors & ~present;
    }

    Fill fill_;
    bool near_, counts_ = false;
    std::uint64_t oldest_;  ///< bit of the oldest way
    unsigned sector_bits_;
    std::vector<Set> sets_;
    LineFills fills_;
};

template <unsigned vectors>
Level* new_with(const CacheGeometry& geometry, unsigned caches) {
    return new LruFewWays<vectors>(geometry, caches);
}

Level* new_lru_few_ways(const CacheGeometry& geometry, unsigned caches) {
    static constexpr decltype(&new_with<1>) makers[] = {new_with<1>, new_with<2>, new_with<3>, new_with<4>,
                                                        new_with<5>, new_with<6>, new_with<7>, new_with<8>};
    return makers[(geometry.ways - 1) / lanes_of_vector](geometry, caches);
}

}  // namespace
}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "cachesim/dispatch.hpp"

namespace raycache::cachesim {

HWY_EXPORT(new_lru_few_ways);

bool suits_lru_few_ways(const CacheGeometry& geometry, std::uint64_t lines, InstructionSet instructions) {
    if (instructions == InstructionSet::scalar) return false;
    // Above, a hash table is faster (measured: docs/benchmarks.md).
    const std::uint64_t most_ways = instructions >= InstructionSet::avx2 ? 64 : 32;
    const auto sectors = geometry.line_bytes / geometry.sector_bytes;
    return geometry.ways <= most_ways && sectors < 32 && lines <= std::uint64_t{1} << (32 - sectors);
}

std::unique_ptr<Level> make_lru_few_ways(const CacheGeometry& geometry, unsigned caches, InstructionSet instructions) {
    return std::unique_ptr<Level>(RAYCACHE_DISPATCH(new_lru_few_ways, instructions)(geometry, caches));
}

}  // namespace raycache::cachesim
#endif
