#include "traces/printable.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>

namespace raycache {
namespace {

constexpr std::uint32_t invalid = 0xffffffff;

struct Decoded {
    std::uint32_t point = invalid;
    std::size_t bytes = 1;
};

/// The code point at the start of a text that is not empty; `invalid` for one byte of no UTF-8 (RFC 3629).
Decoded decode(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < size) return {};
    std::uint32_t point = lead & (0x7fU >> size);
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xc0U) != 0x80) return {};
        point = point << 6 | (byte(i) & 0x3fU);
    }
    const bool overlong = (size == 3 && point < 0x800) || (size == 4 && point < 0x10000);
    if (overlong || point > 0x10ffff || (point >= 0xd800 && point < 0xe000)) return {};
    return {point, size};
}

bool is_control(std::uint32_t c) { return c < 0x20 || (c >= 0x7f && c < 0xa0); }

/// Characters without a shape of their own that change how their neighbours are shown.
bool is_invisible(std::uint32_t c) {
    return c == 0xad || c == 0x61c || c == 0x180e || (c >= 0x200b && c <= 0x200f) || (c >= 0x2028 && c <= 0x202e) ||
           (c >= 0x2060 && c <= 0x206f) || c == 0xfeff || (c >= 0xfff9 && c <= 0xfffb) ||
           (c >= 0xe0000 && c <= 0xe007f);
}

/// `replace(point, out)` appends what stands for a character that may not be shown.
template <class Replace>
std::string rewrite(std::string_view text, Replace replace) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const auto [point, bytes] = decode(text);
        if (point == invalid || is_control(point) || is_invisible(point))
            replace(point, out);
        else
            out.append(text.substr(0, bytes));
        text.remove_prefix(bytes);
    }
    return out;
}

}  // namespace

std::size_t utf8_bytes(std::string_view text) {
    const auto [point, bytes] = decode(text);
    return point == invalid ? 0 : bytes;
}

std::string printable_line(std::string_view text) {
    return rewrite(text, [](std::uint32_t point, std::string& out) {
        out += point == '\t' || point == '\n' || point == '\r' ? ' ' : '?';
    });
}

std::string printable_text(std::string_view text) {
    return rewrite(text, [](std::uint32_t point, std::string& out) {
        out += point == '\n' ? '\n' : point == '\t' || point == '\r' ? ' ' : '?';
    });
}

std::string printable_json(std::string_view text) {
    return rewrite(text, [](std::uint32_t point, std::string& out) {
        if (point == '\n' || point == '\t' || point == '\r')
            out += static_cast<char>(point);
        else if (point == invalid)
            out += "\\ufffd";
        else if (point < 0x10000)
            fmt::format_to(std::back_inserter(out), "\\u{:04x}", point);
        else
            fmt::format_to(std::back_inserter(out), "\\u{:04x}\\u{:04x}", 0xd7c0 + (point >> 10),
                           0xdc00 + (point & 0x3ff));
    });
}

}  // namespace raycache
