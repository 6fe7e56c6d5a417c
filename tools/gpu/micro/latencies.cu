// What pointer chases tell: latencies, the edge of L1, conflicts in its sets, and what a miss fills.
#include <cmath>

#include "tools/gpu/micro/chase.cuh"
#include "tools/gpu/micro/parts.hpp"

namespace raycache::gpu {
namespace {

constexpr std::uint64_t line = 128, sector = 32, kib = 1024, mib = kib * kib;

double median_of(const std::vector<double>& ascending) { return ascending[ascending.size() / 2]; }

/// Of chases over footprints from 4 KiB to 1 GiB (quick: 256 MiB).
Series footprints(Chaser& chaser, Way way, bool quick) {
    Series series{way == Way::l1 ? "latency through L1" : "latency past L1",
                  "footprint in bytes",
                  "cycles of a dependent load",
                  "one thread, one load a line of 128 B, lines in random order; the first round is not timed",
                  {}};
    const std::uint64_t most = quick ? 256 * mib : 1024 * mib;
    for (std::uint64_t bytes = 4 * kib; bytes <= most; bytes *= 2)
        for (const std::uint64_t size : {bytes, bytes + bytes / 2}) {
            if (size > most) break;
            const auto places = strided(size, line);
            chaser.load(random_list(places, size / 4));
            // Of a large list a part is enough: nothing of it is seen twice.
            const auto lines = static_cast<std::uint32_t>(places.size());
            const std::uint32_t steps = std::min<std::uint32_t>(lines, 16384);
            const std::uint32_t warm = lines > (1U << 20) ? 1024 : lines;
            series.points.push_back({static_cast<double>(size), chaser.run(way, warm, steps).cycles});
        }
    return series;
}

/// Cycles of single loads that hit L2: where it has two halves, some lines are far.
Series near_and_far(Chaser& chaser) {
    const std::uint64_t bytes = 2 * mib;
    const auto places = strided(bytes, line);
    chaser.load(random_list(places, bytes / 4));
    const auto lines = static_cast<std::uint32_t>(places.size());
    const auto result = chaser.run(Way::l2, lines, lines, 0, true);
    Series series{"latency of L2, line by line",
                  "share of lines",
                  "cycles, at most",
                  "one SM, 2 MiB read once before: quantiles over lines; two plateaus are a near and a far half",
                  {}};
    for (int i = 1; i < 40; ++i) {
        const double share = i / 40.0;
        series.points.push_back({share, result.each[static_cast<std::size_t>(share * static_cast<double>(lines))]});
    }
    return series;
}

/// Share of loads that miss L1, over footprints in fine steps.
Series l1_edge(Chaser& chaser, double limit, bool quick) {
    Series series{"misses of L1",
                  "footprint in bytes",
                  "share of loads slower than half way to L2",
                  "one thread, lines of 128 B in random order, three rounds before",
                  {}};
    for (std::uint64_t size = 8 * kib; size <= 272 * kib; size += (quick ? 16 : 4) * kib) {
        const auto places = strided(size, line);
        chaser.load(random_list(places, size / 4));
        const auto lines = static_cast<std::uint32_t>(places.size());
        series.points.push_back({static_cast<double>(size), chaser.run(Way::l1, 3 * lines, lines, limit).slow_share});
    }
    return series;
}

/// How many lines, each so many bytes behind the one before, L1 holds.
Series conflicts(Chaser& chaser, double limit) {
    Series series{"lines that L1 holds at a stride",
                  "stride in bytes",
                  "lines, the most that do not miss",
                  "one thread, two rounds before; up to 2048 lines, 64 MiB: powers of two, then halving",
                  {}};
    for (std::uint64_t stride = line; stride <= mib; stride *= 2) {
        const std::uint64_t most = std::min<std::uint64_t>(2048, 64 * mib / stride);
        const auto misses = [&](std::uint64_t lines) {
            const auto places = strided(lines * stride, stride);
            chaser.load(random_list(places, lines * stride / 4));
            const auto n = static_cast<std::uint32_t>(lines);
            return chaser.run(Way::l1, 2 * n, n, limit).slow_share > 0.02;
        };
        std::uint64_t holds = 1, fails = 2;
        while (fails <= most && !misses(fails)) {
            holds = fails;
            fails *= 2;
        }
        fails = std::min(fails, most + 1);
        while (fails - holds > 1) {
            const std::uint64_t middle = (holds + fails) / 2;
            (misses(middle) ? fails : holds) = middle;
        }
        series.points.push_back({static_cast<double>(stride), static_cast<double>(holds)});
    }
    return series;
}

/// Pairs of loads in 1024 places far apart: the first 32 B sector of a block of 256 B, which misses everything, then
/// the sector `n` of it. Median cycles of the second.
Series fill(Chaser& chaser, Way way) {
    Series series{way == Way::l1 ? "a sector behind a miss, through L1" : "a sector behind a miss, past L1",
                  "sector of the 256 B block whose first was read just before",
                  "median cycles",
                  way == Way::l1 ? "as fast as L1: a miss of L1 fills it, too; else as fast as L2, or as DRAM"
                                 : "as fast as L2: a miss of L2 fetches it, too; else as fast as DRAM",
                  {}};
    const std::uint32_t blocks = 1024;
    const std::uint64_t apart = 256 * kib;  // 256 MiB: nothing of it was read before
    for (std::uint32_t n = 0; n < 8; ++n) {
        std::vector<std::uint32_t> list(blocks * apart / 4);
        std::mt19937 random(n);
        // Blocks at random places within their part of memory, so that they share no bank or set.
        std::vector<std::uint32_t> starts;
        for (std::uint32_t b = 0; b < blocks; ++b)
            starts.push_back(
                static_cast<std::uint32_t>((b * apart + (b == 0 ? 0 : random() % (apart / 256)) * 256) / 4));
        std::shuffle(starts.begin() + 1, starts.end(), random);
        for (std::uint32_t b = 0; b < blocks; ++b) {
            const std::uint32_t first = starts[b], second = first + n * sector / 4 + (n == 0 ? 1 : 0);
            list[first] = second;
            list[second] = starts[(b + 1) % blocks];
        }
        chaser.load(list);
        chaser.flush_l2();
        const auto result = chaser.run(way, 0, 2 * blocks, 0, true, false);
        std::vector<double> second;
        for (std::size_t i = 1; i < result.each.size(); i += 2) second.push_back(result.each[i]);
        std::sort(second.begin(), second.end());
        series.points.push_back({static_cast<double>(n), median_of(second)});
    }
    return series;
}

}  // namespace

std::vector<Series> measure_latencies(const CudaDevice& device, bool quick) {
    Chaser chaser(2 * device.l2_bytes());
    std::vector<Series> all{footprints(chaser, Way::l1, quick), footprints(chaser, Way::l2, quick)};
    // Half way from L1 to L2: 8 KiB hit the one, and past it the other.
    const double l1 = all[0].points[2].second, l2 = all[1].points[2].second;
    const double limit = (l1 + l2) / 2;
    all.push_back(near_and_far(chaser));
    all.push_back(l1_edge(chaser, limit, quick));
    all.push_back(conflicts(chaser, limit));
    all.push_back(fill(chaser, Way::l1));
    all.push_back(fill(chaser, Way::l2));
    return all;
}

}  // namespace raycache::gpu
