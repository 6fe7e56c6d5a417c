#include "traces/accelsim/instruction_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "traces/record.hpp"

namespace raycache::traces {
namespace {

constexpr unsigned most_destinations = 1, most_sources = 8;
constexpr std::uint64_t window_bytes = std::uint64_t{1} << 24;  // of generic addresses that lead to other memory

constexpr unsigned zero_register = 255, not_numbered = 256;

/// The number of "R4", "UR4", "P0", "UP0"; that of RZ for "RZ" and "PT"; not_numbered: it is no register.
unsigned register_number(std::string_view word) {
    if (word.starts_with('U')) word.remove_prefix(1);
    if (word == "RZ" || word == "PT") return zero_register;
    if (!word.starts_with('R') && !word.starts_with('P')) return not_numbered;
    unsigned number = not_numbered;
    const auto [end, error] = std::from_chars(word.data() + 1, word.data() + word.size(), number);
    return error == std::errc{} && end == word.data() + word.size() && number <= zero_register ? number : not_numbered;
}

/// Bulk copies of the tensor memory accelerator, whose addresses have a form of their own.
bool is_bulk_copy(std::string_view opcode) { return opcode.starts_with("UTMA") || opcode.starts_with("UBLK"); }

/// The words of a line, one after the other.
class Words {
public:
    Words(std::string_view line, const TextPlace& lines) : rest_(line), lines_(lines) {}

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

    /// A whole number, or 0x and a hexadecimal one; 0 if the next word is none.
    std::uint64_t number_or_0() {
        std::string_view digits = word("immediate");
        const bool hexadecimal = digits.starts_with("0x");
        if (hexadecimal) digits.remove_prefix(2);
        std::uint64_t value = 0;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value, hexadecimal ? 16 : 10);
        return error == std::errc{} && end == digits.data() + digits.size() ? value : 0;
    }

    /// Those that are R and a number, but for RZ, are added to `set`, if it is given.
    void registers(const char* what, unsigned most, RegisterSet* set = nullptr) {
        const auto count = number<unsigned>(what, 10);
        if (count > most) lines_.refuse(what, fmt::format("at most {}", most), fmt::format("{}", count));
        for (unsigned i = 0; i < count; ++i) {
            const std::string_view found = word("register");
            const unsigned number = register_number(found);
            if (number == not_numbered) lines_.refuse("register", "R, UR or P and a number up to 255", found);
            if (set && found[0] == 'R' && number != zero_register) set->set(number);
        }
    }

private:
    std::string_view rest_;
    const TextPlace& lines_;
};

/// The widest number in the opcode's parts, in bits: 128 in LDG.E.128, 16 in LDG.E.U16; 32 bits without one.
std::uint32_t access_bytes(std::string_view opcode, const TextPlace& lines) {
    std::uint32_t bits = 32;
    for (std::string_view rest = opcode; !rest.empty();) {
        std::string_view part = rest.substr(0, rest.find('.'));
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        if (part.starts_with('U') || part.starts_with('S')) part.remove_prefix(1);
        std::uint32_t number = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
        if (error == std::errc{} && end == part.data() + part.size()) bits = number;
    }
    if (bits < 8 || bits > 256 || !std::has_single_bit(bits))
        lines.refuse("width in the opcode", "8, 16, 32, 64, 128 or 256 bits", opcode);
    return bits / 8;
}

void read_addresses(Words& words, const TextPlace& lines, std::uint32_t mask, std::vector<std::uint64_t>& out) {
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

/// Whether an instruction of this opcode is the load or store named, of global memory; a generic one is where its
/// address says so.
bool is_global(const char* global, const char* generic, std::string_view opcode, const InstructionGrammar& grammar,
               std::uint64_t address) {
    const std::string_view name = opcode.substr(0, opcode.find('.'));
    if (name == global) return true;
    const auto inside = [&](std::uint64_t window) { return window != 0 && address - window < window_bytes; };
    return name == generic && !inside(grammar.shared_window) && !inside(grammar.local_window);
}

}  // namespace

InstructionLine parse_instruction(std::string_view line, const InstructionGrammar& grammar, const TextPlace& place,
                                  GlobalLoad& load) {
    Words words(line, place);
    for (unsigned i = 0; i < grammar.numbers_before; ++i) words.number<std::uint64_t>("number before it", 10);
    load.pc = words.number<std::uint64_t>("program counter", 16);
    load.mask = words.number<std::uint32_t>("mask", 16);
    load.written.reset();
    load.read.reset();
    words.registers("number of destinations", most_destinations, &load.written);
    InstructionLine found;
    found.opcode = words.word("opcode");
    if (is_bulk_copy(found.opcode)) {
        found.has_addresses = load.mask != 0;
        return found;
    }
    words.registers("number of sources", most_sources, &load.read);
    const auto width = words.number<unsigned>("memory width", 10);
    found.has_addresses = width != 0 && load.mask != 0;
    if (!found.has_addresses) {  // what follows has a meaning for few
        if (width == 0 && !words.empty()) found.immediate = words.number_or_0();
        return found;
    }
    read_addresses(words, place, load.mask, load.addresses);
    if (!words.empty()) words.word("immediate");
    if (!words.empty() && grammar.version < 6)
        place.refuse("end of the instruction", "an immediate and no more", words.word(""));
    const std::uint64_t address = load.addresses.front();
    load.is_store = grammar.stores && is_global("STG", "ST", found.opcode, grammar, address);
    found.is_access = load.is_store || is_global("LDG", "LD", found.opcode, grammar, address) ||
                      is_global("LDGSTS", "", found.opcode, grammar, address);
    if (!found.is_access) return found;
    load.bytes = access_bytes(found.opcode, place);
    constexpr std::uint32_t register_bytes = 4;
    const RegisterSet first = load.written;
    for (std::uint32_t r = 1; r < load.bytes / register_bytes; ++r) load.written |= first << r;
    load.read |= load.read << 1;
    for (const std::uint64_t each : load.addresses)
        if (each % load.bytes != 0)
            place.refuse("address", fmt::format("a multiple of {}", load.bytes), fmt::format("{:#x}", each));
    return found;
}

unsigned count_numbers_before(std::string_view line) {
    constexpr unsigned own = 3;  // program counter, mask, number of destinations
    unsigned count = 0;
    for (std::string_view rest = line;; ++count) {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
        if (rest.empty()) return 0;
        if (rest[0] >= 'A' && rest[0] <= 'Z') return count < own ? 0 : count - own;
        rest.remove_prefix(std::min(rest.find_first_of(" \t"), rest.size()));
    }
}

}  // namespace raycache::traces
