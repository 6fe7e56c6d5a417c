#include <fmt/format.h>

#include <array>
#include <bit>
#include <filesystem>

#include "tools/gpu/package/package.hpp"
#include "tools/gpu/package/package_format.hpp"
#include "traces/bytes.hpp"
#include "traces/compression.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"

namespace raycache::gpu {
namespace {

static_assert(std::endian::native == std::endian::little, "sections hold numbers as they lie in memory");

using Section = std::span<const std::uint8_t>;

template <class T>
Section bytes_of(std::span<const T> elements) {
    return {reinterpret_cast<const std::uint8_t*>(elements.data()), elements.size_bytes()};
}

void write_file(const std::string& path, std::uint32_t kind, std::uint64_t id,
                const std::array<std::uint32_t, 4>& numbers, const std::string& text,
                std::span<const Section> sections) {
    const std::uint64_t head = format::table_at + sections.size() * format::entry_bytes + text.size();
    std::vector<std::uint64_t> offsets;
    std::uint64_t end = head + format::sum_bytes;
    for (const Section& section : sections) {
        offsets.push_back(format::aligned(end));
        end = offsets.back() + section.size();
    }
    traces::Bytes out;
    traces::append(out, format::magic);
    traces::append(out, format::version);
    traces::append(out, kind);
    traces::append(out, id);
    traces::append(out, end);
    traces::append(out, static_cast<std::uint32_t>(sections.size()));
    traces::append(out, static_cast<std::uint32_t>(text.size()));
    for (const std::uint32_t number : numbers) traces::append(out, number);
    for (std::size_t i = 0; i < sections.size(); ++i) {
        traces::append(out, offsets[i]);
        traces::append(out, std::uint64_t{sections[i].size()});
        traces::append(out, traces::checksum(sections[i]));
    }
    traces::append(out, text);
    traces::seal(out);

    traces::OutputFile file(path);
    file.write(out);
    for (std::size_t i = 0; i < sections.size(); ++i) {
        file.write(traces::Bytes(offsets[i] - file.bytes()));
        file.write(sections[i]);
    }
    file.commit();
}

std::string within(const std::string& folder, const std::string& name) {
    return (std::filesystem::path(folder) / name).string();
}

}  // namespace

std::string launch_file(std::uint32_t ordinal) { return fmt::format("launch-{}.rcgp", ordinal); }

std::vector<std::string> package_files(const std::string& folder, std::uint32_t launches) {
    std::vector<std::string> files;
    for (std::uint32_t i = 0; i < launches; ++i) files.push_back(within(folder, launch_file(i)));
    files.push_back(within(folder, bvh_file));
    return files;
}

TreeKind tree_kind(const std::string& name) {
    for (const TreeKind kind : {TreeKind::bvh2, TreeKind::bvh4, TreeKind::cwbvh8})
        if (to_string(kind) == name) return kind;
    throw Error(
        fmt::format("a replay package of layout {}: expected bvh2, bvh4 or cwbvh8, of whose nodes tools/gpu/ "
                    "has a walk",
                    name));
}

std::string to_string(TreeKind kind) {
    return kind == TreeKind::bvh2 ? "bvh2" : kind == TreeKind::bvh4 ? "bvh4" : "cwbvh8";
}

void identify(PackageHead& head, const BvhPart& bvh) {
    traces::Bytes all;
    traces::append(all, head.provenance);
    traces::append(all, traces::checksum(bvh.nodes));
    traces::append(all, traces::checksum(bvh.triangles));
    head.id = traces::checksum(all);
}

void write_launch(const std::string& folder, const PackageHead& package, const LaunchHead& head,
                  const LaunchPart& launch) {
    const std::array<Section, format::launch_sections> sections{bytes_of(launch.batches), bytes_of(launch.rays),
                                                                bytes_of(launch.hits), bytes_of(launch.hole_firsts),
                                                                bytes_of(launch.hole_triangles)};
    write_file(within(folder, launch_file(head.ordinal)), format::launch_kind, package.id,
               {head.ordinal, head.first_index, head.warps, 0}, "", sections);
}

void write_bvh_part(const std::string& folder, const PackageHead& head, const BvhPart& bvh) {
    const std::array<Section, format::bvh_sections> sections{bvh.nodes, bvh.triangles};
    write_file(within(folder, bvh_file), format::bvh_kind, head.id,
               {head.launches, static_cast<std::uint32_t>(head.tree), head.wavefront ? 1U : 0U, 0}, head.provenance,
               sections);
}

}  // namespace raycache::gpu
