#include "traces/accelsim/traceg_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

#include "traces/error.hpp"

namespace raycache::traces {
namespace {

constexpr std::uint32_t code_bytes = 0x1000;  // of a region: at most 256 loads, 16 bytes of code each
constexpr unsigned address_register = 4, first_register = 8, registers = 6;

const char* opcode(std::uint32_t bytes) {
    switch (bytes) {
        case 16:
            return "LDG.E.128.SYS";
        case 8:
            return "LDG.E.64.SYS";
        case 4:
            return "LDG.E.SYS";
        case 2:
            return "LDG.E.U16.SYS";
        default:
            return "LDG.E.U8.SYS";
    }
}

/// Largest power of two up to 16 that divides every element's address.
std::uint32_t alignment(const Region& region) {
    return static_cast<std::uint32_t>(std::uint64_t{1}
                                      << std::countr_zero(region.base | region.stride | std::uint64_t{16}));
}

/// " 1 BASE STRIDE" where lanes are contiguous and equally spaced, else " 2 BASE DIFFERENCES".
void append_addresses(std::uint32_t mask, const std::vector<std::uint64_t>& addresses, std::string& out) {
    const std::uint32_t from_lowest = mask >> std::countr_zero(mask);
    bool regular = addresses.size() > 1 && (from_lowest & (from_lowest + 1)) == 0;
    for (std::size_t i = 2; regular && i < addresses.size(); ++i)
        regular = addresses[i] - addresses[i - 1] == addresses[1] - addresses[0];
    const auto to = std::back_inserter(out);
    fmt::format_to(to, " {} 0x{:x}", regular ? 1 : 2, addresses[0]);
    const std::size_t differences = regular ? 1 : addresses.size() - 1;
    for (std::size_t i = 0; i < differences; ++i)
        fmt::format_to(to, " {}", static_cast<std::int64_t>(addresses[i + 1] - addresses[i]));
}

}  // namespace

TracegText::TracegText(const Header& header, const TracegSettings& settings,
                       std::function<void(std::string_view)> write)
    : header_(header), settings_(settings), write_(std::move(write)) {
    if (settings.warps_per_cta < 1 || settings.warps_per_cta > 32)
        throw UsageError(fmt::format("warps per CTA {}; expected 1 to 32", settings.warps_per_cta));
    for (const Region& region : header.regions) {
        auto& loads = loads_.emplace_back();
        const std::uint32_t most = alignment(region);
        for (std::uint32_t at = 0, bytes = 0; at < region.element_size; at += bytes) {
            bytes = std::min(most, std::bit_floor(region.element_size - at));
            loads.push_back({at, bytes});
            if (loads.size() * 16 > code_bytes)
                throw Error(
                    fmt::format("region of {} B objects at {:#x}: expected at most {} loads an object, found more; "
                                "align the region to 16 B",
                                region.element_size, region.base, code_bytes / 16));
        }
    }
    const std::uint64_t ctas =
        (std::uint64_t{header.warps_per_launch} + settings.warps_per_cta - 1) / settings.warps_per_cta;
    write_(
        fmt::format("-kernel name = raycache\n-kernel id = 1\n-grid dim = ({},1,1)\n-block dim = ({},1,1)\n"
                    "-shmem = 0\n-nregs = 32\n-binary version = {}\n-cuda stream id = 0\n"
                    "-shmem base_addr = 0x00007f0000000000\n-local mem base_addr = 0x00007e0000000000\n"
                    "-nvbit version = 1.5.5\n-accelsim tracer version = 5\n-enable lineinfo = 0\n\n"
                    "#traces format = PC mask dest_num [reg_dests] opcode src_num [reg_srcs] mem_width "
                    "[address_mode] [addresses] immediate\n",
                    ctas, settings.warps_per_cta * warp_lanes, settings.binary_version));
}

void TracegText::add(const WarpTrace& warp) {
    add_instructions(warp);
    end_warp();
}

void TracegText::add_instructions(const WarpTrace& warp) {
    const std::uint32_t* element = warp.elements.data();
    std::vector<std::uint64_t> addresses;
    for (const Record& record : warp.records) {
        if (!record.is_access()) continue;
        const Region& region = header_.regions[record.region];
        const auto& loads = loads_[record.region];
        for (std::size_t i = 0; i < loads.size(); ++i) {
            addresses.clear();
            for (unsigned lane = 0; lane < record.lanes(); ++lane)
                addresses.push_back(region.address(element[lane]) + loads[i].offset);
            const unsigned to =
                i + 1 == loads.size() ? address_register : first_register + 4 * static_cast<unsigned>(i % registers);
            fmt::format_to(std::back_inserter(lines_), "{:04x} {:08x} 1 R{} {} 1 R{} {}",
                           record.region * code_bytes + i * 16, record.mask, to, opcode(loads[i].bytes),
                           address_register, loads[i].bytes);
            append_addresses(record.mask, addresses, lines_);
            lines_ += " 0\n";
            ++instructions_;
        }
        element += record.lanes();
    }
}

void TracegText::end_warp() {
    std::string text;
    if (warp_ == 0) text = fmt::format("\n#BEGIN_TB\n\nthread block = {},0,0\n", cta_);
    text += fmt::format("\nwarp = {}\ninsts = {}\n", warp_, instructions_ + 1);
    write_(text);
    lines_ += fmt::format("{:04x} ffffffff 0 EXIT 0 0 0\n", header_.regions.size() * code_bytes);
    write_(lines_);
    lines_.clear();
    instructions_ = 0;
    if (++warp_ < settings_.warps_per_cta) return;
    write_("\n#END_TB\n");
    warp_ = 0;
    ++cta_;
}

void TracegText::finish() {
    while (warp_ != 0) end_warp();
}

}  // namespace raycache::traces
