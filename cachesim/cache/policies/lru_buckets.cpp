#include "cachesim/cache/policies/lru_buckets.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "cachesim/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/cache/policies/lru_buckets.cpp"
#include <hwy/foreach_target.h>

#include "cachesim/vector_ops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {
namespace {

constexpr std::uint32_t lanes = 16;  ///< of a bucket
constexpr std::uint32_t no_line = ~std::uint32_t{0};
/// A state is time << 8, whether the line is in the queue, and its sectors.
constexpr int time_shift = 8;
constexpr std::uint32_t queued = 1u << 7, sectors_mask = queued - 1;
constexpr std::uint32_t never = ~std::uint32_t{0};  ///< state of an empty slot: later than any time
constexpr std::uint32_t end_of_time = (1u << 24) - 1;

struct alignas(64) Bucket {
    std::uint32_t words[lanes];
};

/// What one cache has beside its tags and states.
struct Cache {
    std::uint32_t now = 0;      ///< look-ups so far
    std::uint32_t horizon = 0;  ///< lines last used before are in the queues of their sets
    std::uint32_t span = 64;    ///< by how much the horizon moves
};
/// Lines of a set, and its queue: of the set's places, those from `begin` to `end`.
struct Set {
    std::uint32_t lines = 0, begin = 0, end = 0;
};

/// Bit i: word i of the bucket is equal.
HWY_INLINE std::uint32_t equal(const Bucket& bucket, std::uint32_t word) {
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < lanes; i += lanes_of_vector)
        bits |= bits_of(hn::Eq(hn::Load(words_tag, bucket.words + i), all(word))) << i;
    return bits;
}

class LruBuckets final : public Level {
public:
    LruBuckets(const CacheGeometry& geometry, unsigned caches)
        : fill_(geometry),
          ways_(static_cast<std::uint32_t>(geometry.ways)),
          sets_per_cache_(static_cast<std::uint32_t>(geometry.slices * geometry.sets)),
          buckets_(std::bit_ceil(std::max(1u, sets_per_cache_ * ways_ / (lanes / 2)))),  // half full
          slots_(buckets_ * lanes),
          bucket_shift_(32 - std::countr_zero(buckets_)),
          tags_(std::size_t{caches} * buckets_, filled(no_line)),
          states_(std::size_t{caches} * buckets_, filled(never)),
          set_of_(std::size_t{caches} * slots_),
          strayed_(std::size_t{caches} * buckets_),
          sets_(std::size_t{caches} * sets_per_cache_),
          queues_(sets_.size() * ways_),
          caches_(caches),
          ages_(slots_ + lanes),
          slots_by_age_(slots_ + lanes) {}

    void process(const std::uint32_t* sets, const std::uint32_t* lines, std::uint32_t* sectors,
                 std::size_t count) override {
        for (std::size_t i = 0; i < count;) {
            const std::uint32_t number = sets[i] / sets_per_cache_;
            Cache& cache = caches_[number];
            if (cache.now == end_of_time) [[unlikely]]
                start_time_anew(number);
            fetch(number, count - i);
            const std::size_t end = std::min<std::size_t>(count, i + (end_of_time - cache.now));
            i = fill_.widens() ? process_one<true>(number, sets, lines, sectors, i, end)
                               : process_one<false>(number, sets, lines, sectors, i, end);
        }
    }

    LineFills fills() const override { return fills_; }

private:
    /// Look-ups from `i` to at most `end` as long as they are to this cache. Returns the first that was not done.
    template <bool widens>
    std::size_t process_one(std::uint32_t number, const std::uint32_t* sets, const std::uint32_t* lines,
                            std::uint32_t* sectors, std::size_t i, std::size_t end) {
        const std::uint32_t first = number * sets_per_cache_, sets_per_cache = sets_per_cache_;
        const Bucket* const tags = tags_of(number);
        std::uint32_t* const states = states_of(number);
        const int shift = bucket_shift_;
        std::uint32_t now = caches_[number].now;
        for (; i < end && sets[i] - first < sets_per_cache; ++i, ++now) {
            const std::uint32_t line = lines[i], wanted = sectors[i], bucket = home(line, shift);
            const std::uint32_t found = equal(tags[bucket], line);
            if (found) [[likely]] {
                std::uint32_t& state = states[bucket * lanes + static_cast<std::uint32_t>(std::countr_zero(found))];
                const std::uint32_t present = state & sectors_mask;
                const std::uint32_t fetched = widens ? widened(wanted & ~present, present) : wanted & ~present;
                sectors[i] = fetched;
                state = now << time_shift | present | fetched;
            } else {
                caches_[number].now = now;
                sectors[i] = look_further(number, sets[i], line, wanted);
            }
        }
        caches_[number].now = now;
        return i;
    }

    /// Brings tags and states near, if there are so many look-ups that most will be asked for.
    void fetch(std::uint32_t number, std::size_t lookups) {
        if (lookups < buckets_) return;
        for (std::uint32_t b = 0; b < buckets_; ++b) {
            __builtin_prefetch(tags_of(number) + b);
            __builtin_prefetch(states_of(number) + std::size_t{b} * lanes, 1);
        }
    }

    Bucket* tags_of(std::uint32_t number) { return &tags_[std::size_t{number} * buckets_]; }
    std::uint32_t* states_of(std::uint32_t number) { return states_[std::size_t{number} * buckets_].words; }

    static Bucket filled(std::uint32_t word) {
        Bucket bucket;
        std::fill(std::begin(bucket.words), std::end(bucket.words), word);
        return bucket;
    }

    /// Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    static std::uint32_t home(std::uint32_t line, int shift) {
        return static_cast<std::uint32_t>(std::uint64_t{line * 0x9e3779b1u} >> shift);
    }
    std::uint32_t home(std::uint32_t line) const { return home(line, bucket_shift_); }

    /// What is fetched for missing sectors.
    std::uint32_t widened(std::uint32_t missing, std::uint32_t present) const {
        return fill_.widens() && missing ? fill_.pieces(missing) & ~present : missing;
    }

    /// The line is not in the bucket where it belongs: it has strayed to another one, or is absent.
    std::uint32_t look_further(std::uint32_t number, std::uint32_t set_number, std::uint32_t line,
                               std::uint32_t wanted) {
        Bucket* const tags = tags_of(number);
        std::uint32_t* const states = states_of(number);
        std::uint32_t* const strayed = &strayed_[std::size_t{number} * buckets_];
        const std::uint32_t stamp = caches_[number].now << time_shift;
        const std::uint32_t belongs = home(line);
        if (strayed[belongs]) [[unlikely]] {
            for (std::uint32_t b = next(belongs); b != belongs; b = next(b)) {
                const std::uint32_t found = equal(tags[b], line);
                if (!found) continue;
                std::uint32_t& state = states[b * lanes + static_cast<std::uint32_t>(std::countr_zero(found))];
                const std::uint32_t present = state & sectors_mask, fetched = widened(wanted & ~present, present);
                state = stamp | present | fetched;
                return fetched;
            }
        }
        Set& set = sets_[set_number];
        ++fills_.line_misses;
        if (set.lines == ways_) [[likely]] {
            evict(number, set_number);
        } else {
            ++set.lines;
            ++fills_.of_empty_ways;
        }
        std::uint32_t bucket = belongs, empty = equal(tags[bucket], no_line);
        if (!empty) [[unlikely]] {
            ++strayed[belongs];
            while (!(empty = equal(tags[bucket = next(bucket)], no_line))) continue;
        }
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(empty));
        const std::uint32_t fetched = widened(wanted, 0);
        tags[bucket].words[lane] = line;
        states[bucket * lanes + lane] = stamp | wanted | fetched;
        set_of_[std::size_t{number} * slots_ + bucket * lanes + lane] = set_number;
        return fetched;
    }
    std::uint32_t next(std::uint32_t bucket) const { return (bucket + 1) & (buckets_ - 1); }

    /// Takes out the least recently used line of the set.
    void evict(std::uint32_t number, std::uint32_t set_number) {
        Set& set = sets_[set_number];
        const std::uint32_t* const queue = &queues_[std::size_t{set_number} * ways_];
        std::uint32_t* const states = states_of(number);
        std::uint32_t slot = 0;
        do {
            while (set.begin == set.end) [[unlikely]] move_horizon(number);
            slot = queue[set.begin++];
        } while (!is_queued(states[slot]));  // it was used after all
        std::uint32_t& tag = tags_of(number)[slot / lanes].words[slot % lanes];
        if (const std::uint32_t belongs = home(tag); belongs != slot / lanes) [[unlikely]]
            --strayed_[std::size_t{number} * buckets_ + belongs];
        tag = no_line;
        states[slot] = never;
    }
    static bool is_queued(std::uint32_t state) { return (state & queued) != 0 && state != never; }

    /// Puts lines into the queues of their sets, oldest first: those that were last used between the horizon and a
    /// later one. No two were used at the same time, so the time is where to put them for sorting.
    [[gnu::noinline]] void move_horizon(std::uint32_t number) {
        Cache& cache = caches_[number];
        std::uint32_t* const states = states_of(number);
        const std::uint32_t span = std::min(cache.span, cache.now - cache.horizon);
        const Vector from = all(cache.horizon), width = all(span);
        std::uint32_t found = 0;
        for (std::uint32_t slot = 0; slot < slots_; slot += lanes_of_vector) {
            const Vector time = hn::ShiftRight<time_shift>(hn::Load(words_tag, states + slot));
            const Vector age = hn::Sub(time, from);
            const Mask between = hn::Lt(age, width);
            store(&ages_[found], compressed(age, between));
            store(&slots_by_age_[found], compressed(hn::Add(places(), all(slot)), between));
            found += count_of(between);
        }
        by_time_.assign((span + lanes - 1) / lanes * lanes, no_line);
        for (std::uint32_t i = 0; i < found; ++i) by_time_[ages_[i]] = slots_by_age_[i];
        std::uint32_t sorted = 0;
        for (std::size_t t = 0; t < by_time_.size(); t += lanes_of_vector) {
            const Vector slots = load(&by_time_[t]);
            const Mask some = hn::Ne(slots, all(no_line));
            store(&slots_by_age_[sorted], compressed(slots, some));
            sorted += count_of(some);
        }
        forget_used(number);
        for (std::uint32_t i = 0; i < sorted; ++i) {
            const std::uint32_t slot = slots_by_age_[i];
            const std::uint32_t set_number = set_of_[std::size_t{number} * slots_ + slot];
            queues_[std::size_t{set_number} * ways_ + sets_[set_number].end++] = slot;
            states[slot] |= queued;
        }
        cache.horizon += span;
        // About one line in eight: then neither the search for them nor those used after all weigh much.
        if (sorted < slots_ / 20) cache.span = std::min(slots_, cache.span + cache.span / 4 + 1);
        if (sorted > slots_ / 12) cache.span = std::max(lanes, cache.span - cache.span / 4);
    }

    /// Drops from the queues the lines that were used since, so that none is in its queue twice.
    void forget_used(std::uint32_t number) {
        const std::uint32_t* const states = states_of(number);
        const std::uint32_t first = number * sets_per_cache_;
        for (std::uint32_t s = first; s < first + sets_per_cache_; ++s) {
            Set& set = sets_[s];
            std::uint32_t* const queue = &queues_[std::size_t{s} * ways_];
            std::uint32_t kept = 0;
            for (std::uint32_t i = set.begin; i < set.end; ++i) {
                queue[kept] = queue[i];
                kept += is_queued(states[queue[i]]);
            }
            set.begin = 0;
            set.end = kept;
        }
    }

    /// Numbers the times at which lines were last used from 0, in their order.
    void start_time_anew(std::uint32_t number) {
        std::uint32_t* const states = states_of(number);
        std::vector<std::uint32_t> used;
        for (std::uint32_t slot = 0; slot < slots_; ++slot)
            if (states[slot] != never) used.push_back(slot);
        std::sort(used.begin(), used.end(), [&](std::uint32_t a, std::uint32_t b) { return states[a] < states[b]; });
        std::uint32_t time = 0;
        for (const std::uint32_t slot : used) states[slot] = time++ << time_shift | (states[slot] & sectors_mask);
        const std::uint32_t first = number * sets_per_cache_;
        for (std::uint32_t s = first; s < first + sets_per_cache_; ++s) sets_[s].begin = sets_[s].end = 0;
        caches_[number].now = time;
        caches_[number].horizon = 0;
    }

    Fill fill_;
    std::uint32_t ways_, sets_per_cache_, buckets_, slots_;  ///< buckets and slots of one cache
    int bucket_shift_;
    std::vector<Bucket> tags_, states_;
    std::vector<std::uint32_t> set_of_;   ///< of each line that is present, by slot
    std::vector<std::uint32_t> strayed_;  ///< by bucket: lines that belong there and are elsewhere, as it was full
    std::vector<Set> sets_;
    std::vector<std::uint32_t> queues_;  ///< slots; places for `ways` of each set
    std::vector<Cache> caches_;
    std::vector<std::uint32_t> ages_, slots_by_age_, by_time_;  ///< of move_horizon()
    LineFills fills_;
};

Level* new_lru_buckets(const CacheGeometry& geometry, unsigned caches) { return new LruBuckets(geometry, caches); }

}  // namespace
}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "cachesim/dispatch.hpp"

namespace raycache::cachesim {

HWY_EXPORT(new_lru_buckets);

bool suits_lru_buckets(const CacheGeometry& geometry, InstructionSet instructions) {
    const std::uint64_t lines = geometry.lines();
    return instructions >= InstructionSet::avx2 && geometry.line_bytes / geometry.sector_bytes < 8 &&
           lines <= std::uint64_t{1} << 22;
}

std::unique_ptr<Level> make_lru_buckets(const CacheGeometry& geometry, unsigned caches, InstructionSet instructions) {
    return std::unique_ptr<Level>(RAYCACHE_DISPATCH(new_lru_buckets, instructions)(geometry, caches));
}

}  // namespace raycache::cachesim
#endif
