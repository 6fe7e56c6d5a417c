#include "traces/loads/load_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "traces/error.hpp"
#include "traces/format.hpp"
#include "traces/loads/region_plan.hpp"
#include "traces/memory_budget.hpp"
#include "traces/writer.hpp"

namespace raycache::traces {
namespace {

constexpr std::uint64_t most_block_lanes = std::uint64_t{1} << 20;
constexpr std::size_t block_warps = 64, block_empty_warps = std::size_t{1} << 16;
/// Of a record and its lanes, in the warp and while it is encoded.
constexpr std::uint64_t record_bytes = 32, lane_bytes = 24, step_bytes = 32;

class LaunchWriter {
public:
    LaunchWriter(Writer& writer, const Header& header, RegionPlan& plan, MemoryBudget& budget, const LoadPass& pass)
        : writer_(writer), header_(header), plan_(plan), budget_(budget), pass_(pass) {}

    void run(std::uint32_t launch) {
        launch_ = launch;
        next_ = 0;
        const LoadKernel kernel = pass_.kernel(launch);
        std::uint64_t cta = 0;
        pass_.read(launch, [&](std::uint64_t warp, const LoadAccess& access) {
            // Warps of CTAs before are whole.
            if (warp / kernel.warps_per_cta != cta) {
                finish_warps();
                cta = warp / kernel.warps_per_cta;
            }
            add(warp, access);
        });
        finish_warps();
        pad(kernel.warps, block_warps);
        flush();
        pad(header_.warps_per_launch, block_empty_warps);
        flush();
    }

private:
    void add(std::uint64_t number, const LoadAccess& access) {
        if (number < next_ || number >= header_.warps_per_launch)
            throw Error(
                fmt::format("{}: expected the same loads when it was read again, found others; nothing may "
                            "change the file while it is read",
                            pass_.file));
        if (access.mask == 0) {
            if (const auto at = open_.find(number); at != open_.end()) end_steps(at->second, access.steps);
            return;
        }
        budget_.charge(record_bytes + lane_bytes * access.lanes(), pass_.file, "loads of its warps");
        if (number != current_ || !warp_) {
            warp_ = &open_[number];
            current_ = number;
        }
        WarpTrace& warp = *warp_;
        if (warp.elements.size() + access.lanes() > format::max_block_lanes / 2)
            throw Error(fmt::format("{}: warp {}: expected at most {} lane accesses, found more; trace a smaller part",
                                    pass_.file, number, format::max_block_lanes / 2));
        if (warp.records.empty()) warp.records.push_back({0, ray_start, RayType::camera, 0, 0});
        warp.records.front().mask |= access.mask;
        add_steps(warp, access.steps);
        const std::uint8_t region = plan_.place(access, warp.elements);
        warp.records.push_back({access.mask, region, RayType::camera, 0, 0});
    }

    /// The first record is a ray start.
    static std::uint32_t accesses_of(const WarpTrace& warp) {
        return static_cast<std::uint32_t>(warp.records.empty() ? 0 : warp.records.size() - 1);
    }

    /// They stand before the next access.
    void add_steps(WarpTrace& warp, const std::vector<IssueStep>& steps) {
        budget_.charge(step_bytes * steps.size(), pass_.file, "loads of its warps");
        for (const IssueStep& step : steps) warp.issue.push_back({accesses_of(warp), step.needs, step.instructions});
    }

    /// The last ones; there is at least one.
    void end_steps(WarpTrace& warp, const std::vector<IssueStep>& steps) {
        if (steps.empty())
            add_steps(warp, {{}});
        else
            add_steps(warp, steps);
    }

    void finish_warps() {
        for (auto& [number, warp] : open_) {
            pad(number, block_warps);
            if (!block_.empty() && lanes_ + warp.elements.size() > most_block_lanes) flush();
            lanes_ += warp.elements.size();
            append(std::move(warp), block_warps);
        }
        open_.clear();
        warp_ = nullptr;
    }

    /// Warps without records up to that one; many of them in large blocks.
    void pad(std::uint64_t number, std::size_t most) {
        constexpr std::uint64_t many = 4096;
        if (next_ + many < number) {
            flush();
            most = block_empty_warps;
        }
        while (next_ < number) append({}, most);
        if (most == block_empty_warps) flush();
    }

    void append(WarpTrace&& warp, std::size_t most) {
        if (block_.size() >= most) flush();
        warp.launch = launch_;
        warp.warp = next_++;
        block_.push_back(std::move(warp));
    }

    void flush() {
        if (block_.empty()) return;
        writer_.append(encode_block(header_, block_));
        for (const WarpTrace& warp : block_) {
            const std::size_t starts = warp.records.empty() ? 0 : 1;
            budget_.release(record_bytes * (warp.records.size() - starts) + lane_bytes * warp.elements.size() +
                            step_bytes * warp.issue.size());
        }
        block_.clear();
        lanes_ = 0;
    }

    Writer& writer_;
    const Header& header_;
    RegionPlan& plan_;
    MemoryBudget& budget_;
    const LoadPass& pass_;
    std::uint32_t launch_ = 0, next_ = 0;      ///< next_: number of the warp that follows those of block_
    std::map<std::uint64_t, WarpTrace> open_;  ///< of the CTA that is read
    WarpTrace* warp_ = nullptr;                ///< of open_, the last one
    std::uint64_t current_ = 0;                ///< its number
    std::vector<WarpTrace> block_;
    std::uint64_t lanes_ = 0;  ///< of block_
};

}  // namespace

void write_loads(const LoadPass& pass, Header header, const std::string& output) {
    MemoryBudget budget;
    RegionPlan plan(budget, pass.file);
    bool any = false;
    std::uint64_t warps = 0;
    header.launches.clear();
    for (std::size_t launch = 0; launch < pass.launches; ++launch) {
        pass.read(launch, [&](std::uint64_t, const LoadAccess& access) {
            if (access.mask == 0) return;
            any = true;
            plan.add(access);
        });
        const LoadKernel kernel = pass.kernel(launch);
        warps = std::max(warps, kernel.warps);
        if (kernel.warps > format::max_warps_per_launch)
            throw Error(fmt::format("{}: expected at most 2^26 warps, found {}; trace a smaller grid", pass.file,
                                    kernel.warps));
        header.launches.push_back(static_cast<std::uint32_t>(launch));
    }
    if (!any)
        throw Error(fmt::format("{}: expected global loads (LDG, LDGSTS, LD), found none; trace a kernel that has some",
                                pass.file));
    header.warps_per_launch = static_cast<std::uint32_t>(warps);
    header.regions = plan.regions();
    pass.finish(header);
    Writer writer(output, header);
    LaunchWriter launches(writer, header, plan, budget, pass);
    for (std::uint32_t launch = 0; launch < pass.launches; ++launch) launches.run(launch);
    writer.finish();
}

}  // namespace raycache::traces
