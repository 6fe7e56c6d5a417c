#include "traces/accelsim/instruction_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "traces/record.hpp"

namespace raycache::traces {
namespace {

/// The words of a line, one after the other.
class Words {
public:
    Words(std::string_view line, const TextLines& lines) : rest_(line), lines_(lines) {}

    bool empty() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
        return rest_.empty();
    }

    std::string_view word(const char* what) {
        if (empty()) lines_.refuse(what, "a word", "the end of the line");
        const std::string_view found = rest_.substr(0, rest_.find_first_of(" \t"));
        rest_.remove_prefix(found.size());
        return found;
    }

    template <class Number>
    Number number(const char* what, int base) {
        const std::string_view found = word(what);
        std::string_view digits = found;
        if (base == 16 && (digits.starts_with("0x") || digits.starts_with("0X"))) digits.remove_prefix(2);
        Number value{};
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
        if (error != std::errc{} || end != digits.data() + digits.size())
            lines_.refuse(what, base == 16 ? "a hexadecimal number" : "a whole number", found);
        return value;
    }

    void registers(const char* what, unsigned most) {
        const auto count = number<unsigned>(what, 10);
        if (count > most) lines_.refuse(what, fmt::format("at most {}", most), fmt::format("{}", count));
        for (unsigned i = 0; i < count; ++i) {
            const std::string_view found = word("register");
            if (found[0] != 'R') lines_.refuse("register", "R and a number", found);
        }
    }

private:
    std::string_view rest_;
    const TextLines& lines_;
};

/// The widest number in the opcode's parts, in bits: 128 in LDG.E.128, 16 in LDG.E.U16; 32 bits without one.
std::uint32_t access_bytes(std::string_view opcode, const TextLines& lines) {
    std::uint32_t bits = 32;
    for (std::string_view rest = opcode; !rest.empty();) {
        std::string_view part = rest.substr(0, rest.find('.'));
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        if (part.starts_with('U') || part.starts_with('S')) part.remove_prefix(1);
        std::uint32_t number = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
        if (error == std::errc{} && end == part.data() + part.size()) bits = number;
    }
    if (bits < 8 || bits > 128 || !std::has_single_bit(bits))
        lines.refuse("width in the opcode", "8, 16, 32, 64 or 128 bits", opcode);
    return bits / 8;
}

void read_addresses(Words& words, const TextLines& lines, std::uint32_t mask, std::vector<std::uint64_t>& out) {
    const auto mode = words.number<unsigned>("address mode", 10);
    const auto lanes = static_cast<unsigned>(std::popcount(mask));
    out.clear();
    if (mode > 2) lines.refuse("address mode", "0, 1 or 2", fmt::format("{}", mode));
    out.push_back(words.number<std::uint64_t>("address", 16));
    if (mode == 1) {
        const std::uint32_t from_lowest = mask >> std::countr_zero(mask);
        if ((from_lowest & (from_lowest + 1)) != 0)
            lines.refuse("address mode 1", "contiguous active lanes", fmt::format("mask {:08x}", mask));
        const auto stride = static_cast<std::uint64_t>(words.number<std::int64_t>("stride of the addresses", 10));
        while (out.size() < lanes) out.push_back(out.back() + stride);
    }
    while (out.size() < lanes)
        out.push_back(mode == 0
                          ? words.number<std::uint64_t>("address", 16)
                          : out.back() + static_cast<std::uint64_t>(words.number<std::int64_t>("difference", 10)));
}

}  // namespace

InstructionLine parse_instruction(std::string_view line, bool line_numbers, const TextLines& lines, GlobalLoad& load) {
    Words words(line, lines);
    if (line_numbers) words.number<std::uint64_t>("source line", 10);
    load.pc = words.number<std::uint64_t>("program counter", 16);
    load.mask = words.number<std::uint32_t>("mask", 16);
    words.registers("number of destinations", 1);
    InstructionLine found;
    found.opcode = words.word("opcode");
    words.registers("number of sources", 4);
    const auto width = words.number<unsigned>("memory width", 10);
    found.has_addresses = width != 0 && load.mask != 0;
    found.is_load = found.has_addresses && found.opcode.substr(0, found.opcode.find('.')) == "LDG";
    if (!found.has_addresses) return found;  // what follows has no meaning here
    read_addresses(words, lines, load.mask, load.addresses);
    if (!words.empty()) words.word("immediate");
    if (!words.empty()) lines.refuse("end of the instruction", "an immediate and no more", words.word(""));
    if (!found.is_load) return found;
    load.bytes = access_bytes(found.opcode, lines);
    for (const std::uint64_t address : load.addresses)
        if (address % load.bytes != 0 || address >> 48 != 0)
            lines.refuse("address", fmt::format("a multiple of {} below 2^48", load.bytes),
                         fmt::format("{:#x}", address));
    return found;
}

}  // namespace raycache::traces
