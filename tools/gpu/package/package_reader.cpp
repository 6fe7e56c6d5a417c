#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <utility>

#include "tools/gpu/package/package.hpp"
#include "tools/gpu/package/package_format.hpp"
#include "tools/gpu/package/tree_check.hpp"
#include "traces/bytes.hpp"
#include "traces/compression.hpp"
#include "traces/fault.hpp"
#include "traces/printable.hpp"
#include "traces/regular_file.hpp"

namespace raycache::gpu {
namespace {

constexpr const char* again = "copy the package again, or capture it again";
constexpr std::uint64_t most_file_bytes = std::uint64_t{1} << 40;

[[noreturn]] void refuse(const std::string& path, const std::string& what, const std::string& expected,
                         const std::string& found, const char* remedy = again) {
    throw Error(printable_line(fmt::format("{}: {}: expected {}, found {}; {}", path, what, expected, found, remedy)));
}

std::string within(const std::string& folder, const std::string& name) {
    return (std::filesystem::path(folder) / name).string();
}

const char* name_of(std::uint32_t kind) { return kind == format::bvh_kind ? "a BVH" : "a launch"; }

unsigned sections_of(std::uint32_t kind) {
    return kind == format::bvh_kind ? format::bvh_sections : format::launch_sections;
}

/// A section as elements of one type.
template <class T>
std::span<const T> elements(const PackageFile& file, unsigned section, const char* what) {
    const auto bytes = file.section(section);
    if (bytes.size() % sizeof(T) != 0)
        refuse(file.path(), what, fmt::format("a multiple of {} bytes", sizeof(T)), fmt::format("{}", bytes.size()));
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

}  // namespace

PackageFile::PackageFile(const std::string& path, std::uint32_t kind)
    : path_(path), bytes_(read_regular_file(path, "replay package", nullptr, most_file_bytes)) {
    const auto at32 = [&](std::size_t at) { return traces::load<std::uint32_t>(&bytes_[at]); };
    const auto at64 = [&](std::size_t at) { return traces::load<std::uint64_t>(&bytes_[at]); };
    const std::uint64_t size = bytes_.size();
    if (!traces::starts_with(bytes_, format::magic))
        refuse(path, "first bytes", "a file of a replay package", "something else",
               "name a folder that `raycache capture --gpu-package` wrote");
    const auto need = [&](std::uint64_t bytes) {
        if (size < bytes) refuse(path, "size", fmt::format("at least {} bytes", bytes), fmt::format("{}", size));
    };
    need(format::table_at + format::sum_bytes);
    if (at32(format::version_at) != format::version)
        refuse(path, "version", fmt::format("{}", format::version), fmt::format("{}", at32(format::version_at)),
               "capture it with this version of raycache");
    if (at32(format::kind_at) != kind)
        refuse(path, "kind", fmt::format("{} ({})", kind, name_of(kind)), fmt::format("{}", at32(format::kind_at)));
    if (at64(format::bytes_at) != size)
        refuse(path, "size", fmt::format("{} bytes", at64(format::bytes_at)), fmt::format("{}", size));
    const unsigned count = sections_of(kind);
    if (at32(format::sections_at) != count)
        refuse(path, "sections", fmt::format("{}", count), fmt::format("{}", at32(format::sections_at)));
    const std::uint64_t table_end = format::table_at + std::uint64_t{count} * format::entry_bytes;
    const std::uint64_t head = table_end + at32(format::text_at);
    need(head + format::sum_bytes);
    const auto sum_of = [&](std::string_view what, std::span<const std::uint8_t> part, std::uint64_t stored) {
        const std::uint64_t computed = traces::checksum(part);
        if (computed != stored)
            refuse(path, fmt::format("checksum of the {}", what), traces::hex64(stored), traces::hex64(computed));
    };
    sum_of("head", std::span(bytes_).first(head), at64(head));
    id_ = at64(format::id_at);
    for (unsigned i = 0; i < numbers_.size(); ++i) numbers_[i] = at32(format::numbers_at + 4 * i);
    text_.assign(reinterpret_cast<const char*>(&bytes_[table_end]), at32(format::text_at));
    std::uint64_t end = head + format::sum_bytes;
    for (unsigned i = 0; i < count; ++i) {
        const std::size_t entry = format::table_at + std::size_t{i} * format::entry_bytes;
        const std::uint64_t offset = at64(entry + format::section_offset_at),
                            length = at64(entry + format::section_bytes_at);
        const std::string what = fmt::format("section {}", i);
        if (offset != format::aligned(end) || offset > size || length > size - offset)
            refuse(path, what, "one within the file, behind the one before",
                   fmt::format("{} bytes at {}", length, offset));
        const auto between = std::span(bytes_).subspan(end, offset - end);
        if (std::any_of(between.begin(), between.end(), [](std::uint8_t byte) { return byte != 0; }))
            refuse(path, what, "zeros before it", "something else");
        const auto bytes = std::span(bytes_).subspan(offset, length);
        sum_of(what, bytes, at64(entry + format::section_sum_at));
        sections_.emplace_back(bytes);
        end = offset + length;
    }
    if (end != size) refuse(path, "size", fmt::format("{} bytes", end), fmt::format("{}", size));
}

BvhFile::BvhFile(const std::string& folder) : file_(within(folder, bvh_file), format::bvh_kind) {
    head_.id = file_.id();
    head_.launches = file_.number(0);
    head_.provenance = file_.text();
    head_.wavefront = file_.number(2) != 0;
    head_.tree = TreeKind{file_.number(1)};
    if (head_.tree != TreeKind::bvh2 && head_.tree != TreeKind::bvh4 && head_.tree != TreeKind::cwbvh8)
        refuse(file_.path(), "tree", "2 (bvh2), 4 (bvh4) or 8 (cwbvh8)", fmt::format("{}", file_.number(1)));
    if (head_.launches == 0) refuse(file_.path(), "launches", "at least 1", "0");
    part_ = {file_.section(0), file_.section(1)};
    const TreeFacts facts = check_tree(head_.tree, part_);
    if (facts.fault != nullptr) refuse(file_.path(), "BVH", facts.fault, "none");
    stack_entries_ = facts.stack_entries;
}

LaunchFile::LaunchFile(const std::string& folder, const BvhFile& bvh, std::uint32_t ordinal)
    : file_(within(folder, launch_file(ordinal)), format::launch_kind) {
    if (file_.id() != bvh.head().id || file_.number(0) != ordinal)
        refuse(file_.path(), "package", fmt::format("launch {} of {}", ordinal, traces::hex64(bvh.head().id)),
               fmt::format("launch {} of {}", file_.number(0), traces::hex64(file_.id())),
               "two captures wrote to one folder; capture it again");
    head_ = {file_.number(0), file_.number(1), file_.number(2)};
    part_.batches = elements<Batch>(file_, 0, "batches");
    part_.rays = elements<PackedRay>(file_, 1, "rays");
    part_.hits = elements<Hit>(file_, 2, "hits");
    part_.hole_firsts = elements<std::uint32_t>(file_, 3, "firsts of holes");
    part_.hole_triangles = elements<std::uint32_t>(file_, 4, "triangles of holes");
    const auto check = [&](bool holds, const char* what, const char* expected) {
        if (!holds) refuse(file_.path(), what, expected, "others");
    };
    std::uint64_t rays = 0;
    std::uint32_t warp = 0;
    for (const Batch& batch : part_.batches) {
        check(batch.mask != 0 && batch.first_ray == rays && batch.type <= 2 && batch.warp < head_.warps &&
                  (bvh.head().wavefront || batch.warp >= warp),
              "batches", "such that follow each other, warp by warp");
        warp = batch.warp;
        rays += static_cast<unsigned>(std::popcount(batch.mask));
    }
    check(part_.rays.size() == rays && part_.hits.size() == rays, "rays and hits", "as many as the batches have");
    const auto& firsts = part_.hole_firsts;
    check(firsts.size() == rays + 1 && firsts.front() == 0 && firsts.back() == part_.hole_triangles.size() &&
              std::is_sorted(firsts.begin(), firsts.end()),
          "holes", "a list for each ray");
}

}  // namespace raycache::gpu
