#include "traces/addresses/guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "traces/accelsim/byte_source.hpp"
#include "traces/accelsim/kernel_list.hpp"
#include "traces/bytes.hpp"
#include "traces/error.hpp"
#include "traces/rtwarp/import.hpp"

namespace raycache::traces {
namespace {

constexpr std::size_t enough = 4096;
constexpr std::string_view hexadecimal = "0123456789abcdefABCDEF", decimal = "0123456789", blanks = " \t";

bool consists_of(std::string_view text, std::string_view letters) {
    return !text.empty() && text.find_first_not_of(letters) == std::string_view::npos;
}

/// The first lines that say anything; the last one may be cut.
std::vector<std::string_view> first_lines(std::string_view text, std::size_t most) {
    std::vector<std::string_view> lines;
    while (!text.empty() && lines.size() < most) {
        std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.find_first_not_of(blanks) != std::string_view::npos) lines.push_back(line);
    }
    return lines;
}

/// "0 7f5000000040"
bool is_dinero(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    if (line.size() < 3 || line[0] < '0' || line[0] > '4' || !consists_of(line.substr(1, 1), blanks)) return false;
    line.remove_prefix(std::min(line.find_first_not_of(blanks, 1), line.size()));
    std::string_view digits = line.substr(0, line.find_first_of(blanks));
    if (digits.starts_with("0x")) digits.remove_prefix(2);
    return digits.size() <= 16 && consists_of(digits, hexadecimal);
}

/// "I  04001090,3", " L 1ffefffe50,8", or what Valgrind says about itself
bool is_lackey(std::string_view line) {
    if (line.starts_with("==") && line.find("==", 2) != std::string_view::npos) return true;
    const bool access = line.size() > 4 &&
                        (line.starts_with("I  ") || (line[0] == ' ' && line[2] == ' ' &&
                                                     std::string_view("LSM").find(line[1]) != std::string_view::npos));
    if (!access) return false;
    const std::string_view place = line.substr(3), digits = place.substr(0, place.find(','));
    return digits.size() < place.size() && consists_of(digits, hexadecimal);
}

bool is_csv(std::string_view line) {
    return line.find(',') != std::string_view::npos || consists_of(line, decimal) ||
           (line.starts_with("0x") && consists_of(line.substr(2), hexadecimal));
}

bool is_text(std::string_view bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](char c) {
        return static_cast<unsigned char>(c) >= 32 || c == '\n' || c == '\r' || c == '\t';
    });
}

/// Records of 24 bytes: u32 time, u64 object, u32 size, i64 number of the next access to it, or -1.
bool is_oracle(std::string_view bytes) {
    constexpr std::size_t record = 24;
    std::uint32_t before = 0;
    std::size_t count = 0;
    for (; (count + 1) * record <= bytes.size(); ++count) {
        const auto* at = reinterpret_cast<const std::uint8_t*>(bytes.data()) + count * record;
        const auto time = load<std::uint32_t>(at), size = load<std::uint32_t>(at + 12);
        const auto next = static_cast<std::int64_t>(load<std::uint64_t>(at + 16));
        if (time < before || size == 0 || size > 1u << 30 || next < -2 || next > std::int64_t{1} << 40) return false;
        before = time;
    }
    return count > 0;
}

[[noreturn]] void refuse_kind(const std::string& path, std::string_view found, std::string_view remedy) {
    throw Error(
        fmt::format("{}: expected an Accel-Sim trace (.traceg, .tracez, kernelslist.g), an RTWARP01 trace, or "
                    "addresses (din, csv, u64), found {}; {}",
                    path, found, remedy));
}

}  // namespace

TraceKind guess_trace_kind(const std::string& path) {
    if (looks_like_kernel_list(path)) return TraceKind::accel_sim;
    if (looks_like_rtwarp(path)) return TraceKind::rtwarp;
    const std::string text = first_bytes(path, enough);
    if (text.empty()) refuse_kind(path, "an empty file", "name another file");
    if (text.starts_with("RCTRACE\x1a")) refuse_kind(path, "a trace of raycache", "replay it as it is");
    if (text.starts_with("MEMTRACE:") || text.find("\nMEMTRACE:") != std::string::npos)
        refuse_kind(path, "what looks like the output of NVBit's mem_trace",
                    "trace with Accel-Sim's tracer (util/tracer_nvbit), and run its post-traces-processing");
    if (text[0] == '-') return TraceKind::accel_sim;
    if (!is_text(text)) {
        if (path.ends_with(".u64")) return TraceKind::u64;
        if (is_oracle(text))
            refuse_kind(path,
                        "what looks like libCacheSim's oracleGeneral (records of time, object, size, next access)",
                        "it names objects, not addresses: write the addresses as csv (address,size)");
        refuse_kind(path, "bytes of another kind", "if they are addresses of 8 bytes, little-endian, say --format u64");
    }
    const std::vector<std::string_view> lines = first_lines(text, 3);
    if (lines.empty()) refuse_kind(path, "blank lines", "name another file");
    const std::string_view first = lines.front();
    if (is_lackey(first))
        refuse_kind(path, "what looks like Valgrind's Lackey (--trace-mem=yes)",
                    "turn its loads into csv: sed -nE 's/^ [LM] ([0-9a-f]+),([0-9]+)/0x\\1,\\2/p'");
    if (is_dinero(first)) return TraceKind::dinero;
    if (first.starts_with("kernel"))
        refuse_kind(path, "what looks like the tracer's kernelslist before post-processing",
                    "run post-traces-processing on it, and import the kernelslist.g that this writes");
    if (is_csv(first)) return TraceKind::csv;
    if (first[0] == '#' || text.find("#BEGIN_TB") != std::string::npos) return TraceKind::accel_sim;
    refuse_kind(path, "text of another kind", "say --format if it is one of these");
}

}  // namespace raycache::traces
