#include "traces/accelsim/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <map>

#include "traces/accelsim/address_regions.hpp"
#include "traces/error.hpp"
#include "traces/format.hpp"
#include "traces/memory_budget.hpp"
#include "traces/writer.hpp"

namespace raycache::traces {
namespace {

constexpr std::uint32_t most_object_bytes = 4096;
constexpr std::size_t most_regions = 254;
constexpr std::uint64_t most_block_lanes = std::uint64_t{1} << 20;

struct Access {
    std::uint32_t mask, bytes;
    std::uint64_t pc;  ///< of its last load
};

struct WarpLoads {
    std::vector<Access> accesses;
    std::vector<std::uint64_t> addresses;  ///< of the active lanes of each access
};

bool continues(const WarpLoads& warp, const GlobalLoad& load) {
    if (warp.accesses.empty()) return false;
    const Access& last = warp.accesses.back();
    if (last.mask != load.mask || last.pc >= load.pc || last.bytes + load.bytes > most_object_bytes) return false;
    const auto* at = warp.addresses.data() + warp.addresses.size() - load.addresses.size();
    return std::equal(load.addresses.begin(), load.addresses.end(), at,
                      [&](std::uint64_t now, std::uint64_t before) { return now == before + last.bytes; });
}

/// Makes room for so many warps.
void grow(std::vector<WarpLoads>& warps, std::uint64_t count, MemoryBudget& budget, const std::string& file) {
    if (count <= warps.size()) return;
    if (count > warps.capacity()) {
        const std::uint64_t room = std::max<std::uint64_t>(count, 2 * warps.capacity());
        budget.charge((room - warps.capacity()) * sizeof(WarpLoads), file, "its warps");
        warps.reserve(room);
    }
    warps.resize(count);
}

void add(std::vector<WarpLoads>& warps, std::uint64_t number, const GlobalLoad& load, bool fuse, MemoryBudget& budget,
         const std::string& file) {
    grow(warps, number + 1, budget, file);
    WarpLoads& warp = warps[number];
    if (fuse && continues(warp, load)) {
        warp.accesses.back().bytes += load.bytes;
        warp.accesses.back().pc = load.pc;
        return;
    }
    // Vectors grow by doubling.
    budget.charge(2 * (sizeof(Access) + load.addresses.size() * sizeof(std::uint64_t)), file, "its loads");
    warp.accesses.push_back({load.mask, load.bytes, load.pc});
    warp.addresses.insert(warp.addresses.end(), load.addresses.begin(), load.addresses.end());
}

/// The regions, and where to find an element: by size of the object, ascending in memory.
struct Layout {
    std::map<std::uint32_t, std::vector<std::pair<CoveredRange, std::uint8_t>>> by_size;
    std::vector<Region> regions;
};

Layout lay_out(const std::vector<WarpLoads>& warps, MemoryBudget& budget, const std::string& file) {
    std::uint64_t count = 0;
    for (const WarpLoads& warp : warps) count += warp.addresses.size();
    const MemoryHold hold(budget, 2 * count * sizeof(std::uint64_t), file, "addresses of its loads");
    std::map<std::uint32_t, std::vector<std::uint64_t>> addresses;
    for (const WarpLoads& warp : warps) {
        const std::uint64_t* at = warp.addresses.data();
        for (const Access& access : warp.accesses) {
            const int lanes = std::popcount(access.mask);
            auto& of_size = addresses[access.bytes];
            of_size.insert(of_size.end(), at, at + lanes);
            at += lanes;
        }
    }
    for (auto& [size, all] : addresses) {
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
    }
    Layout layout;
    for (const auto& [size, all] : addresses)
        for (const CoveredRange& range : cover(all, size, file)) {
            layout.by_size[size].emplace_back(range, static_cast<std::uint8_t>(layout.regions.size()));
            layout.regions.push_back(range.region);
        }
    if (layout.regions.size() <= most_regions) return layout;
    throw Error(
        fmt::format("{}: global loads: expected them to fit {} regions of at most 2^30 elements, found more; trace a "
                    "kernel that reads less memory",
                    file, most_regions));
}

WarpTrace make_warp(const WarpLoads& loads, const Layout& layout, std::uint32_t number) {
    WarpTrace warp;
    warp.warp = number;
    Record start{0, ray_start, RayType::camera, 0, 0};
    for (const Access& access : loads.accesses) start.mask |= access.mask;
    if (start.mask != 0) warp.records.push_back(start);
    const std::uint64_t* at = loads.addresses.data();
    for (const Access& access : loads.accesses) {
        const auto& ranges = layout.by_size.at(access.bytes);
        const std::uint64_t* const end = at + std::popcount(access.mask);
        // Lanes whose objects lie in different regions cannot share a record: one record per region, lowest lane first.
        std::uint32_t left = access.mask;
        const auto range_of = [&](std::uint64_t address) {
            return std::prev(std::upper_bound(ranges.begin(), ranges.end(), address,
                                              [](std::uint64_t a, const auto& r) { return a < r.first.first; }));
        };
        while (left != 0) {
            Record record{0, ray_start, RayType::camera, 0, 0};
            const std::uint64_t* address = at;
            for (std::uint32_t lanes = access.mask; lanes != 0; lanes &= lanes - 1, ++address) {
                const std::uint32_t lane = lanes & -lanes;
                if ((left & lane) == 0) continue;
                const auto range = range_of(*address);
                if (record.mask == 0) record.region = range->second;
                if (record.region != range->second) continue;
                record.mask |= lane;
                left &= ~lane;
                warp.elements.push_back(
                    static_cast<std::uint32_t>((*address - range->first.region.base) / access.bytes));
            }
            warp.records.push_back(record);
        }
        at = end;
    }
    return warp;
}

void write(const Header& header, const std::vector<WarpLoads>& loads, const Layout& layout, const std::string& output) {
    Writer writer(output, header);
    std::vector<WarpTrace> warps;
    std::uint64_t lanes = 0;
    const auto flush = [&] {
        writer.append(encode_block(header, warps));
        warps.clear();
        lanes = 0;
    };
    for (std::uint32_t w = 0; w < loads.size(); ++w) {
        if (!warps.empty() && (warps.size() == 64 || lanes + loads[w].addresses.size() > most_block_lanes)) flush();
        warps.push_back(make_warp(loads[w], layout, w));
        lanes += loads[w].addresses.size();
    }
    flush();
    writer.finish();
}

}  // namespace

TracegKernel import_traceg(const std::string& input, const std::string& output, const ImportSettings& settings) {
    MemoryBudget budget;
    std::vector<WarpLoads> warps;
    TracegKernel kernel = parse_traceg(input, [&](std::uint64_t warp, GlobalLoad& load) {
        if (warp >= format::max_warps_per_launch)
            throw Error(fmt::format("{}: expected at most 2^26 warps, found more; trace a smaller grid", input));
        add(warps, warp, load, settings.fuse, budget, input);
    });
    if (kernel.loads == 0)
        throw Error(fmt::format("{}: expected global loads (LDG), found none; trace a kernel that has some", input));
    const std::uint64_t all = kernel.ctas * kernel.warps_per_cta;
    if (all > format::max_warps_per_launch)
        throw Error(fmt::format("{}: expected at most 2^26 warps, found {}; trace a smaller grid", input, all));
    grow(warps, all, budget, input);

    const Layout layout = lay_out(warps, budget, input);
    Header header;
    header.regions = layout.regions;
    header.launches = {0};
    header.warps_per_launch = static_cast<std::uint32_t>(all);
    header.provenance.program = settings.program;
    header.provenance.command = settings.command;
    header.provenance.scene = kernel.name;
    header.provenance.decorrelation = std::filesystem::path(input).filename().string();
    header.provenance.parameters = fmt::format("warps/CTA={}", kernel.warps_per_cta);
    write(header, warps, layout, output);
    return kernel;
}

}  // namespace raycache::traces
