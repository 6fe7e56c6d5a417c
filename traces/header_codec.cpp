#include "traces/header_codec.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "traces/compression.hpp"
#include "traces/format.hpp"
#include "traces/link_table.hpp"
#include "traces/page_codec.hpp"
#include "traces/provenance.hpp"

namespace raycache::traces {
namespace {

using format::fixed_header_bytes;

/// Refuses `value` outside [least, most].
void bound(const Origin& origin, const std::string& what, std::uint64_t value, std::uint64_t least,
           std::uint64_t most) {
    if (value < least || value > most)
        refuse(origin, what, fmt::format("{} to {}", least, most), fmt::format("{}", value), recapture);
}

/// The rules of header.hpp that need no link table. `at` is the offset of the region's entry.
void check_region(const Region& region, bool paged, unsigned index, std::uint32_t version, const Origin& at) {
    const auto what = [&](const char* field) { return fmt::format("{} of region {}", field, index); };
    bound(at, what("kind"), static_cast<unsigned>(region.kind), 0, object_kinds_of(version) - 1);
    bound(at + 1, what("degree"), region.degree, 0, format::max_degree);
    bound(at + 4, what("element size"), region.element_size, 1, format::max_element_size);
    bound(at + 8, what("base address"), region.base, 0, format::max_address);
    if (region.base % format::region_alignment != 0)
        refuse(at + 8, what("base address"), "a multiple of 2 MiB", hex64(region.base), recapture);
    if (!paged) bound(at + 16, what("stride"), region.stride, region.element_size, 0xffffffffu);
    bound(at + 20, what("count"), region.count, 0, format::max_elements);
    bound(at + 20, what("links"), std::uint64_t{region.degree} * region.count, 0, format::max_links);
    if (paged) check_paged(region, index, at);
}

void check_counts(const Origin& origin, std::uint64_t regions, std::uint64_t launches, std::uint64_t warps) {
    bound(origin + 24, "regions", regions, 1, format::max_regions);
    bound(origin + 28, "launches", launches, 1, format::max_launches);
    bound(origin + 32, "warps per launch", warps, 1, format::max_warps_per_launch);
}

void check_kernels(const Origin& origin, std::uint64_t kernels, std::uint64_t warps) {
    bound(origin + 40, "kernels per launch", kernels, 1, format::max_kernels_per_launch);
    if (warps % kernels != 0)
        refuse(origin + 40, "kernels per launch", fmt::format("a divisor of {} warps per launch", warps),
               fmt::format("{}", kernels), recapture);
}

constexpr std::uint32_t issue_version = 4;  // the first that has WarpTrace::issue

/// The lowest version that can say what the header says.
std::uint32_t version_of(const Header& header) {
    const Provenance none;
    const bool plain = header.kernels_per_launch == 1 && header.provenance.execution == none.execution &&
                       header.provenance.order == none.order;
    std::uint32_t version = plain ? 1 : 2;
    for (const Region& r : header.regions) {
        version = std::max(version, is_known(r.kind) ? role_of(r.kind).version : 2);
        if (!r.pages.empty()) version = std::max(version, 3u);
    }
    return header.issue ? std::max(version, issue_version) : version;
}

void check_links(const Header& header, unsigned self) {
    const Region& region = header.regions[self];
    const Origin origin{"trace header to be written"};
    if (region.links.size() != std::size_t{region.degree} * region.count)
        refuse(origin, fmt::format("links of region {}", self),
               fmt::format("{}", std::size_t{region.degree} * region.count), fmt::format("{}", region.links.size()),
               "give degree * count links");
    for (const std::uint32_t link : region.links) {
        const std::uint32_t to = link >> 30, element = link & 0x3fffffffu;
        if (link != no_link && (to == 3 || to >= header.regions.size() || element >= header.regions[to].count))
            refuse(origin, fmt::format("link of region {}", self), "an element of regions 0 to 2",
                   fmt::format("element {} of region {}", element, to),
                   "link to an element that exists, or use no_link");
    }
}

}  // namespace

Bytes encode_header(const Header& header) {
    const Origin origin{"trace header to be written"};
    check_counts(origin, header.regions.size(), header.launches.size(), header.warps_per_launch);
    check_kernels(origin, header.kernels_per_launch, header.warps_per_launch);
    const std::uint32_t version = version_of(header);
    const std::string provenance = provenance_to_json(header.provenance, version);
    bound(origin, "bytes of provenance", provenance.size(), 1, format::max_provenance_bytes);

    Bytes out;
    append(out, format::file_magic);
    append(out, version);
    append(out, std::uint32_t{0});  // reserved
    append(out, std::uint64_t{0});  // size of the head, filled in below
    append(out, static_cast<std::uint32_t>(header.regions.size()));
    append(out, static_cast<std::uint32_t>(header.launches.size()));
    append(out, header.warps_per_launch);
    append(out, static_cast<std::uint32_t>(provenance.size()));
    append(out, version == 1 ? std::uint32_t{0} : header.kernels_per_launch);
    append(out, std::uint32_t{header.issue});
    for (const std::uint32_t launch : header.launches) append(out, launch);

    Bytes tables, pages;
    for (unsigned i = 0; i < header.regions.size(); ++i) {
        const Region& region = header.regions[i];
        const bool paged = !region.pages.empty();
        check_region(region, paged, i, version, origin);
        check_links(header, i);
        if (paged) encode_pages(region, i, origin, pages);
        const EncodedLinks links = encode_links(region, i);
        append(out, static_cast<std::uint8_t>(region.kind));
        append(out, region.degree);
        append(out, static_cast<std::uint8_t>(links.prediction));
        append(out, std::uint8_t{paged});
        append(out, region.element_size);
        append(out, region.base);
        append(out, region.stride);
        append(out, region.count);
        append(out, static_cast<std::uint64_t>(links.bytes.size()));
        append(out, checksum(links.bytes));
        append(tables, links.bytes);
    }
    append(out, std::string_view(provenance));
    append(out, tables);
    append(out, pages);
    store(out.data() + 16, static_cast<std::uint64_t>(out.size() + format::checksum_bytes));
    seal(out);
    return out;
}

std::uint64_t header_bytes(std::span<const std::uint8_t> front, std::uint64_t file_bytes, const Origin& origin) {
    if (!starts_with(front, format::file_magic.substr(0, std::min(front.size(), format::file_magic.size()))) ||
        front.empty())
        refuse(origin, "magic", "RCTRACE", front.empty() ? "an empty file" : "other bytes",
               "this is no raycache trace: name a file that `raycache capture` or `raycache import` wrote");
    if (front.size() < fixed_header_bytes)
        refuse(origin, "head of the file", fmt::format("at least {} bytes", fixed_header_bytes),
               fmt::format("{}", front.size()), recapture);
    const auto version = load<std::uint32_t>(front.data() + 8);
    if (version > format::version)
        refuse(origin + 8, "format version", fmt::format("at most {}", format::version), fmt::format("{}", version),
               fmt::format("this raycache reads version {}: install a newer one to read version {}", format::version,
                           version));
    if (version == 0) refuse(origin + 8, "format version", fmt::format("1 to {}", format::version), "0", recapture);
    if (const auto reserved = load<std::uint32_t>(front.data() + 12); reserved != 0)
        refuse(origin + 12, "reserved bits", "0", fmt::format("{:#010x}", reserved), recapture);
    if (const auto reserved = load<std::uint64_t>(front.data() + 40); version == 1 && reserved != 0)
        refuse(origin + 40, "reserved bits", "0", hex64(reserved), recapture);
    if (const auto reserved = load<std::uint32_t>(front.data() + 44); reserved > (version >= issue_version ? 1u : 0u))
        refuse(origin + 44, "reserved bits", "0", fmt::format("{:#010x}", reserved), recapture);
    const auto size = load<std::uint64_t>(front.data() + 16);
    bound(origin + 16, "size of the head", size, fixed_header_bytes + format::checksum_bytes, file_bytes);
    return size;
}

Header decode_header(std::span<const std::uint8_t> head, const Origin& origin, MemoryBudget& budget) {
    check_sealed(head, origin, "head", recapture);
    const std::uint8_t* p = head.data();
    const auto version = load<std::uint32_t>(p + 8), regions = load<std::uint32_t>(p + 24),
               launches = load<std::uint32_t>(p + 28), warps = load<std::uint32_t>(p + 32),
               text = load<std::uint32_t>(p + 36);
    check_counts(origin, regions, launches, warps);
    bound(origin + 36, "bytes of provenance", text, 1, format::max_provenance_bytes);
    const std::uint32_t kernels = version == 1 ? 1 : load<std::uint32_t>(p + 40);
    check_kernels(origin, kernels, warps);
    const std::uint64_t table = fixed_header_bytes + std::uint64_t{4} * launches;
    const std::uint64_t provenance = table + std::uint64_t{format::region_bytes} * regions;
    const std::uint64_t end = head.size() - format::checksum_bytes;
    if (provenance + text > end)
        refuse(origin + 16, "size of the head", fmt::format("at least {}", provenance + text + format::checksum_bytes),
               fmt::format("{}", head.size()), recapture);

    Header header;
    header.warps_per_launch = warps;
    header.kernels_per_launch = kernels;
    header.issue = load<std::uint32_t>(p + 44) != 0;
    for (std::uint32_t i = 0; i < launches; ++i)
        header.launches.push_back(load<std::uint32_t>(p + fixed_header_bytes + 4 * std::size_t{i}));
    header.provenance =
        provenance_from_json({reinterpret_cast<const char*>(p + provenance), text}, version, origin + provenance);
    for (unsigned i = 0; i < regions; ++i) {
        const std::uint64_t at = table + format::region_bytes * i;
        const std::uint8_t* entry = p + at;
        header.regions.push_back({static_cast<ObjectKind>(entry[0]),
                                  load<std::uint64_t>(entry + 8),
                                  load<std::uint32_t>(entry + 4),
                                  load<std::uint32_t>(entry + 16),
                                  load<std::uint32_t>(entry + 20),
                                  entry[1],
                                  {},
                                  {}});
        check_region(header.regions.back(), entry[3] == 1 && version >= 3, i, version, origin + at);
        bound(origin + at + 2, fmt::format("link prediction of region {}", i), entry[2], 0, link_predictions - 1);
        if (entry[3] > (version >= 3 ? 1 : 0))
            refuse(origin + at + 3, "reserved bits", "0", fmt::format("{:#04x}", entry[3]), recapture);
    }
    std::uint64_t link_bytes = 0;
    for (const Region& region : header.regions) link_bytes += sizeof(no_link) * region.degree * region.count;
    budget.charge(link_bytes, origin.path, "links of its regions");
    std::uint64_t links = provenance + text;
    for (unsigned i = 0; i < regions; ++i) {
        const std::uint64_t at = table + format::region_bytes * i;
        const auto bytes = load<std::uint64_t>(p + at + 24);
        bound(origin + at + 24, fmt::format("bytes of the links of region {}", i), bytes, 0, end - links);
        const auto stored = head.subspan(links, bytes);
        if (checksum(stored) != load<std::uint64_t>(p + at + 32))
            refuse(origin + links, fmt::format("checksum of the links of region {}", i),
                   hex64(load<std::uint64_t>(p + at + 32)), hex64(checksum(stored)), recapture);
        const MemoryHold window(budget, pieces_memory(stored), origin.path, "decompressing the links of its regions");
        decode_links(header.regions, i, static_cast<LinkPrediction>(p[at + 2]), stored, origin + links);
        links += bytes;
    }
    for (unsigned i = 0; i < regions; ++i)
        if (p[table + format::region_bytes * i + 3] != 0)
            links += decode_pages(header.regions[i], i, head.subspan(links, end - links), origin + links, budget);
    if (links != end)
        refuse(origin + links, "end of the head", fmt::format("offset {}", end), fmt::format("offset {}", links),
               recapture);
    return header;
}

}  // namespace raycache::traces
