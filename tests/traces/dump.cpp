#include "dump.hpp"

#include <fmt/format.h>

#include <vector>

#include "traces/bytes.hpp"
#include "traces/compression.hpp"
#include "traces/provenance.hpp"
#include "traces/reader.hpp"

using namespace raycache::traces;

namespace {

/// As it stands in the file: of version 2 if version 1 would not say all.
std::string provenance_json(const Header& header) {
    bool newer = header.provenance.execution != Provenance{}.execution;
    newer |= header.issue;
    for (const Region& region : header.regions) newer |= !region.pages.empty() || role_of(region.kind).version > 1;
    return provenance_to_json(header.provenance, newer ? 2 : 1);
}

}  // namespace

std::string dump_trace(const std::string& path) {
    const Reader reader(path);
    const Header& header = reader.header();
    std::string text = "provenance " + provenance_json(header) + "\nlaunches";
    for (const auto launch : header.launches) text += fmt::format(" {}", launch);
    text += fmt::format("\nwarps_per_launch {} kernels_per_launch {}\n", header.warps_per_launch,
                        header.kernels_per_launch);
    for (std::size_t i = 0; i < header.regions.size(); ++i) {
        const Region& r = header.regions[i];
        Bytes links;
        for (const auto link : r.links) append(links, link);
        text += fmt::format("region {} kind {} base {:#x} element_size {} stride {} count {} degree {} links {:016x}",
                            i, unsigned(r.kind), r.base, r.element_size, r.stride, r.count, r.degree, checksum(links));
        Bytes pages;
        for (const auto page : r.pages.numbers()) append(pages, page);
        text += pages.empty() ? "\n" : fmt::format(" pages {:016x}\n", checksum(pages));
    }
    std::vector<WarpTrace> warps;
    for (std::size_t i = 0; i < reader.blocks().size(); ++i) {
        reader.read_block(i, warps);
        for (const WarpTrace& warp : warps) {
            text += fmt::format("launch {} warp {}\n", warp.launch, warp.warp);
            const std::uint32_t* element = warp.elements.data();
            for (const Record& r : warp.records) {
                text += fmt::format("{:08x} {} {} {}", r.mask, r.region, unsigned(r.ray), r.bounce);
                for (unsigned n = r.is_access() ? r.lanes() : 0; n > 0; --n) text += fmt::format(" {}", *element++);
                text += '\n';
            }
            for (const IssueStep& step : warp.issue)
                text += fmt::format("step {} {} {}\n", step.access, step.needs, step.instructions);
        }
    }
    return text;
}
