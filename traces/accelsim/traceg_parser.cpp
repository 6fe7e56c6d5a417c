#include "traces/accelsim/traceg_parser.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>

#include "traces/accelsim/instruction_line.hpp"
#include "traces/accelsim/text_lines.hpp"
#include "traces/record.hpp"

namespace raycache::traces {
namespace {

class Parser {
public:
    Parser(const std::string& path, const std::function<void(std::uint64_t, GlobalLoad&)>& load)
        : lines_(path), load_(load) {}

    TracegKernel run() {
        read_header();
        while (next_full_line()) {
            if (line_.starts_with("#BEGIN_TB"))
                read_cta();
            else if (line_[0] != '#')
                lines_.refuse("between thread blocks", "#BEGIN_TB", line_);
        }
        if (kernel_.ctas != grid_)
            lines_.refuse("end of the file", fmt::format("{} thread blocks, as the grid has", grid_),
                          fmt::format("{}", kernel_.ctas));
        return kernel_;
    }

private:
    /// The next line that is not empty.
    bool next_full_line() {
        while (lines_.next(line_))
            if (line_.find_first_not_of(" \t") != std::string_view::npos) return true;
        return false;
    }

    /// What stands behind "KEY = ", if the line has this key.
    std::optional<std::string_view> value_of(std::string_view key) const {
        if (!line_.starts_with(key)) return std::nullopt;
        std::string_view rest = line_.substr(key.size());
        if (!rest.starts_with(" = ")) return std::nullopt;
        return rest.substr(3);
    }

    std::uint64_t number(std::string_view what, std::string_view text) const {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size()) lines_.refuse(what, "a whole number", text);
        return value;
    }

    /// "(x,y,z)", the product of the three.
    std::uint64_t product(std::string_view what, std::string_view text, std::uint64_t most) const {
        std::string_view rest = text;
        if (!rest.starts_with('(') || !rest.ends_with(')')) lines_.refuse(what, "(x,y,z)", text);
        rest = rest.substr(1, rest.size() - 2);
        std::uint64_t volume = 1;
        for (unsigned i = 0; i < 3; ++i) {
            const auto comma = rest.find(',');
            if ((comma == std::string_view::npos) != (i == 2)) lines_.refuse(what, "(x,y,z)", text);
            const std::uint64_t size = number(what, rest.substr(0, comma));
            if (size == 0 || size > most / volume) lines_.refuse(what, fmt::format("a product of 1 to {}", most), text);
            volume *= size;
            rest.remove_prefix(i == 2 ? rest.size() : comma + 1);
        }
        return volume;
    }

    void read_header() {
        while (next_full_line() && line_[0] == '-') {
            if (const auto name = value_of("-kernel name")) kernel_.name = *name;
            if (const auto grid = value_of("-grid dim")) grid_ = product("grid dim", *grid, std::uint64_t{1} << 26);
            if (const auto block = value_of("-block dim"))
                kernel_.warps_per_cta =
                    static_cast<std::uint32_t>((product("block dim", *block, 1024) + warp_lanes - 1) / warp_lanes);
            if (const auto on = value_of("-enable lineinfo")) line_numbers_ = number("enable lineinfo", *on) != 0;
            if (const auto version = value_of("-accelsim tracer version"))
                if (number("accelsim tracer version", *version) > 5)
                    lines_.refuse("accelsim tracer version", "at most 5", *version);
        }
        if (line_.empty() || line_[0] != '#')
            lines_.refuse("header", "lines that begin with '-', then '#traces format'", line_);
        if (grid_ == 0 || kernel_.warps_per_cta == 0)
            lines_.refuse("header", "-grid dim and -block dim", grid_ == 0 ? "no grid dim" : "no block dim");
    }

    void read_cta() {
        if (kernel_.ctas == grid_)
            lines_.refuse("thread block", fmt::format("no more than {}, as the grid has", grid_), "another");
        constexpr std::uint64_t none = ~std::uint64_t{0};
        std::uint64_t warp = none;
        std::vector<bool> seen(kernel_.warps_per_cta);
        while (next_full_line()) {
            if (line_.starts_with("#END_TB")) {
                ++kernel_.ctas;
                return;
            }
            if (line_[0] == '#' || value_of("thread block")) continue;
            if (const auto text = value_of("warp")) {
                warp = number("warp", *text);
                if (warp >= kernel_.warps_per_cta || seen[warp])
                    lines_.refuse("warp", fmt::format("each of 0 to {} once", kernel_.warps_per_cta - 1), *text);
                seen[warp] = true;
            } else if (const auto count = value_of("insts")) {
                if (warp == none) lines_.refuse("thread block", "warp = N before its instructions", line_);
                read_warp(kernel_.ctas * kernel_.warps_per_cta + warp, number("insts", *count));
                warp = none;
            } else {
                lines_.refuse("thread block", "warp, insts or #END_TB", line_);
            }
        }
        lines_.refuse("end of the file", "#END_TB", "a thread block without an end");
    }

    void read_warp(std::uint64_t warp, std::uint64_t instructions) {
        GlobalLoad load;
        for (std::uint64_t i = 0; i < instructions; ++i) {
            if (!next_full_line() || line_[0] == '#' || value_of("warp"))
                lines_.refuse("warp", fmt::format("{} instructions", instructions), fmt::format("{}", i));
            const InstructionLine found = parse_instruction(line_, line_numbers_, lines_, load);
            if (found.is_load) {
                ++kernel_.loads;
                kernel_.bypassing += found.opcode.find(".STRONG.") != std::string_view::npos;
                load_(warp, load);
            } else if (found.has_addresses) {
                leave_out(found.opcode.substr(0, std::min<std::size_t>(found.opcode.find('.'), 16)));
            }
        }
    }

    /// No instruction set has so many: a file without end of made up ones must not fill the memory.
    void leave_out(std::string_view opcode) {
        constexpr std::size_t most = 1000;
        const auto known = kernel_.left_out.find(std::string(opcode));
        if (known != kernel_.left_out.end())
            ++known->second;
        else
            ++kernel_.left_out[kernel_.left_out.size() < most ? std::string(opcode) : "others"];
    }

    TextLines lines_;
    const std::function<void(std::uint64_t, GlobalLoad&)>& load_;
    std::string_view line_;
    TracegKernel kernel_;
    std::uint64_t grid_ = 0;
    bool line_numbers_ = false;
};

}  // namespace

TracegKernel parse_traceg(const std::string& path, const std::function<void(std::uint64_t, GlobalLoad&)>& load) {
    return Parser(path, load).run();
}

}  // namespace raycache::traces
