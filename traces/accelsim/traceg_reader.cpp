#include "traces/accelsim/traceg_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <string>
#include <utility>

#include "traces/record.hpp"

namespace raycache::traces {
namespace {

constexpr unsigned newest_version = 6, first_without_places = 3;

/// The product of three sizes.
std::uint64_t volume(std::string_view what, const std::array<std::uint64_t, 3>& sizes, std::uint64_t most,
                     std::string_view text, const TextPlace& place) {
    std::uint64_t product = 1;
    for (const std::uint64_t size : sizes) {
        if (size == 0 || size > most / product) place.refuse(what, fmt::format("a product of 1 to {}", most), text);
        product *= size;
    }
    return product;
}

std::array<std::uint64_t, 3> sizes(std::string_view what, std::string_view text, const TextPlace& place) {
    if (!text.starts_with('(') || !text.ends_with(')')) place.refuse(what, "(x,y,z)", text);
    return TracegReader::triple(what, text.substr(1, text.size() - 2), place);
}

std::uint64_t address(std::string_view what, std::string_view text, const TextPlace& place) {
    std::uint64_t value = 0;
    std::string_view digits = text;
    if (digits.starts_with("0x")) digits.remove_prefix(2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc{} || end != digits.data() + digits.size()) place.refuse(what, "a hexadecimal number", text);
    return value;
}

}  // namespace

std::optional<std::string_view> TracegReader::value_of(std::string_view line, std::string_view key) {
    if (!line.starts_with(key)) return std::nullopt;
    const std::string_view rest = line.substr(key.size());
    if (!rest.starts_with(" = ")) return std::nullopt;
    return rest.substr(3);
}

std::uint64_t TracegReader::number(std::string_view what, std::string_view text, const TextPlace& place) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) place.refuse(what, "a whole number", text);
    return value;
}

std::array<std::uint64_t, 3> TracegReader::triple(std::string_view what, std::string_view text,
                                                  const TextPlace& place) {
    std::array<std::uint64_t, 3> values{};
    std::string_view rest = text;
    for (unsigned i = 0; i < 3; ++i) {
        const auto comma = rest.find(',');
        if ((comma == std::string_view::npos) != (i == 2)) place.refuse(what, "x,y,z", text);
        values[i] = number(what, rest.substr(0, comma), place);
        rest.remove_prefix(i == 2 ? rest.size() : comma + 1);
    }
    return values;
}

void TracegReader::header_line(std::string_view line, const TextPlace& place) {
    if (const auto name = value_of(line, "-kernel name")) kernel_.name = *name;
    if (const auto grid = value_of(line, "-grid dim")) {
        grid_ = sizes("grid dim", *grid, place);
        kernel_.ctas = volume("grid dim", grid_, std::uint64_t{1} << 26, *grid, place);
    }
    if (const auto block = value_of(line, "-block dim"))
        kernel_.warps_per_cta = static_cast<std::uint32_t>(
            (volume("block dim", sizes("block dim", *block, place), 1024, *block, place) + warp_lanes - 1) /
            warp_lanes);
    if (const auto on = value_of(line, "-enable lineinfo")) line_numbers_ = number("enable lineinfo", *on, place) != 0;
    if (const auto version = value_of(line, "-accelsim tracer version")) {
        const std::uint64_t found = number("accelsim tracer version", *version, place);
        if (found > newest_version)
            place.refuse("accelsim tracer version", fmt::format("at most {}", newest_version), *version);
        grammar_.version = static_cast<unsigned>(found);
    }
    if (const auto base = value_of(line, "-shmem base_addr"))
        grammar_.shared_window = address("shmem base_addr", *base, place);
    if (const auto base = value_of(line, "-local mem base_addr"))
        grammar_.local_window = address("local mem base_addr", *base, place);
}

void TracegReader::end_header(const TextPlace& place) {
    if (kernel_.ctas == 0 || kernel_.warps_per_cta == 0)
        place.refuse("header", "-grid dim and -block dim", kernel_.ctas == 0 ? "no grid dim" : "no block dim");
    constexpr unsigned place_numbers = 4;  // block x y z and warp
    grammar_.numbers_before =
        (grammar_.version > 0 && grammar_.version < first_without_places ? place_numbers : 0) + line_numbers_;
}

void TracegReader::begin_block(const TextPlace& place) {
    if (blocks_ == kernel_.ctas)
        place.refuse("thread block", fmt::format("no more than {}, as the grid has", kernel_.ctas), "another");
    // Its place, unless its coordinates say another.
    block_ = blocks_ == 0 ? 0 : block_ + 1;
    ++blocks_;
    in_block_ = true;
    seen_.assign(kernel_.warps_per_cta, false);
}

void TracegReader::coordinates(std::array<std::uint64_t, 3> at, const TextPlace& place) {
    if (options_.number_by_place || !kernel_.in_order) return;
    for (unsigned i = 0; i < 3; ++i)
        if (at[i] >= grid_[i])
            place.refuse("thread block", fmt::format("below {},{},{}, as the grid is", grid_[0], grid_[1], grid_[2]),
                         fmt::format("{},{},{}", at[0], at[1], at[2]));
    const std::uint64_t number = (at[2] * grid_[1] + at[1]) * grid_[0] + at[0];
    kernel_.in_order = number >= block_;
    block_ = kernel_.in_order ? number : blocks_ - 1;
}

void TracegReader::begin_warp(std::uint64_t number, const TextPlace& place) {
    if (number >= kernel_.warps_per_cta || seen_[number])
        place.refuse("warp", fmt::format("each of 0 to {} once", kernel_.warps_per_cta - 1), fmt::format("{}", number));
    seen_[number] = true;
    end_warp();
    in_warp_ = true;
    exit_ = false;
    handed_on_ = 0;
    scoreboard_.begin_warp();
    warp_ = block_ * kernel_.warps_per_cta + number;
    between_.reset();
}

void TracegReader::end_warp() {
    if (std::exchange(in_warp_, false) && options_.warp_end) options_.warp_end(warp_, scoreboard_.take());
}

/// An instruction that is not handed on; of it, load_ has the registers. The EXIT that ends a warp is no step: a trace of
/// loads alone has no instructions.
void TracegReader::other_instruction(const InstructionLine& line) {
    const std::string_view name = line.opcode.substr(0, line.opcode.find('.'));
    if (name == "LDGDEPBAR") scoreboard_.end_group();
    if (name == "DEPBAR") scoreboard_.wait_for_groups(line.immediate);
    exit_ = name == "EXIT";
    if (!exit_) scoreboard_.instruction(load_.read | load_.written);
}

void TracegReader::hand_on() {
    scoreboard_.wait(load_.read | load_.written);
    load_.steps = scoreboard_.take();
    load_.number = handed_on_++;
    use_(warp_, load_);
}

/// Whether anything of load_ is left.
bool TracegReader::drop_null_lanes() {
    const auto nulls = static_cast<std::uint64_t>(std::count(load_.addresses.begin(), load_.addresses.end(), 0));
    if (nulls == 0) return true;
    kernel_.null_lanes += nulls;
    ++kernel_.null_loads;
    if (options_.null_lanes == NullLanes::keep) return true;
    if (nulls == load_.addresses.size()) return false;
    if (options_.null_lanes == NullLanes::drop_loads) return true;
    auto address = load_.addresses.begin();
    for (std::uint32_t lanes = load_.mask; lanes != 0; lanes &= lanes - 1, ++address)
        if (*address == 0) load_.mask &= ~(lanes & -lanes);
    std::erase(load_.addresses, 0);
    return true;
}

void TracegReader::instruction(std::string_view line, const TextPlace& place) {
    if (first_instruction_ && grammar_.version == 0) {  // not said: as the line is
        const unsigned found = count_numbers_before(line);
        if (found >= 4) grammar_.numbers_before = found;
    }
    first_instruction_ = false;
    const InstructionLine found = parse_instruction(line, grammar_, place, load_);
    if (std::exchange(exit_, false)) scoreboard_.instruction({});  // of some lanes
    if (!found.is_access) {
        between_ |= load_.read | load_.written;
        other_instruction(found);
        if (found.has_addresses) leave_out(found.opcode.substr(0, std::min<std::size_t>(found.opcode.find('.'), 16)));
        return;
    }
    if (load_.is_store) {
        between_ |= load_.read;
        if (!drop_null_lanes()) return other_instruction(found);
        ++kernel_.stores;
        hand_on();
        return;
    }
    load_.between = between_;
    between_.reset();
    if (!drop_null_lanes()) return other_instruction(found);
    ++kernel_.loads;
    kernel_.bypassing += found.opcode.find(".STRONG") != std::string_view::npos ||
                         found.opcode.find(".BYPASS") != std::string_view::npos;
    hand_on();
    if (found.opcode.starts_with("LDGSTS"))
        scoreboard_.async_copy(load_.number);
    else
        scoreboard_.load(load_.written, load_.number);
}

/// No instruction set has so many: a file without end of made up ones must not fill the memory.
void TracegReader::leave_out(std::string_view opcode) {
    constexpr std::size_t most = 1000;
    const auto known = kernel_.left_out.find(std::string(opcode));
    if (known != kernel_.left_out.end())
        ++known->second;
    else
        ++kernel_.left_out[kernel_.left_out.size() < most ? std::string(opcode) : "others"];
}

TracegKernel TracegReader::finish(const TextPlace& place) {
    if (blocks_ == 0 && kernel_.ctas != 0)
        place.refuse("end of the file", fmt::format("thread blocks of a grid of {}", kernel_.ctas), "none");
    if (!kernel_.in_order && blocks_ != kernel_.ctas)
        place.refuse("end of the file",
                     fmt::format("{} thread blocks, as the grid has, or some in ascending order", kernel_.ctas),
                     fmt::format("{} in another order", blocks_));
    kernel_.empty_ctas = kernel_.ctas - blocks_;
    return kernel_;
}

}  // namespace raycache::traces
