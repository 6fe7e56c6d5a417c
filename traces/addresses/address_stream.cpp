#include "traces/addresses/address_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "traces/accelsim/byte_source.hpp"
#include "traces/accelsim/text_lines.hpp"
#include "traces/bytes.hpp"
#include "traces/error.hpp"

namespace raycache::traces {
namespace {

using Use = std::function<void(std::uint64_t, std::uint64_t)>;

std::string_view unquoted(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\""), text.size()));
    return text.substr(0, text.find_last_not_of(" \t\"") + 1);
}

std::optional<std::uint64_t> number(std::string_view text, int base) {
    if (text.starts_with("0x") || text.starts_with("0X")) {
        text.remove_prefix(2);
        base = 16;
    }
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

void check_end(std::uint64_t address, std::uint64_t bytes, const TextPlace& place) {
    if (bytes == 0 || bytes - 1 > ~std::uint64_t{0} - address)
        place.refuse("access", "at least a byte, and an end below 2^64",
                     fmt::format("{} bytes at {:#x}", bytes, address));
}

void read_dinero(TextLines& lines, std::uint64_t bytes, const Use& use, AddressStream& found) {
    for (std::string_view line; lines.next(line);) {
        std::string_view rest = unquoted(line);
        if (rest.empty() || rest[0] == '#') continue;
        const std::string_view label = rest.substr(0, rest.find_first_of(" \t"));
        rest = unquoted(rest.substr(label.size()));
        const std::string_view digits = rest.substr(0, rest.find_first_of(" \t"));
        const auto address = number(digits, 16);
        if (label.size() != 1 || label[0] < '0' || label[0] > '4')
            lines.refuse("label", "0 (read), 1 (write) or 2 (instruction)", label);
        if (label[0] > '2') continue;  // nothing, or a flush
        if (!address) lines.refuse("address", "a hexadecimal number", digits);
        if (label[0] == '0') {
            check_end(*address, bytes, lines);
            ++found.reads;
            use(*address, bytes);
        } else {
            ++(label[0] == '1' ? found.writes : found.fetches);
        }
    }
}

struct Columns {
    std::size_t address = 0;
    std::optional<std::size_t> size, operation;
};

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t comma = line.find(',');
        fields.push_back(unquoted(line.substr(0, comma)));
        if (comma == std::string_view::npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

Columns columns_of(const std::vector<std::string_view>& fields, const TextLines& lines, bool& is_header) {
    is_header = !number(fields[0], 10);
    Columns columns;
    if (!is_header) {
        if (fields.size() > 2)
            lines.refuse("columns", "a header that names the column address, or one or two columns (address, size)",
                         fmt::format("{} columns without a header", fields.size()), "write a header line");
        if (fields.size() == 2) columns.size = 1;
        return columns;
    }
    std::optional<std::size_t> address;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        std::string name(fields[i]);
        std::transform(name.begin(), name.end(), name.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
        if (!address && (name == "address" || name == "addr" || name == "obj" || name == "obj_id")) address = i;
        if (name == "size" || name == "bytes" || name == "obj_size") columns.size = i;
        if (name == "op") columns.operation = i;
    }
    if (!address)
        lines.refuse("header", "a column address, addr, obj or obj_id", fmt::format("{}", fmt::join(fields, ",")),
                     "rename the column of addresses");
    columns.address = *address;
    return columns;
}

void read_csv(TextLines& lines, std::uint64_t bytes, const Use& use, AddressStream& found) {
    std::optional<Columns> columns;
    std::size_t count = 0;
    for (std::string_view line; lines.next(line);) {
        if (unquoted(line).empty()) continue;
        constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
        if (!columns && line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
        const std::vector<std::string_view> fields = fields_of(line);
        if (!columns) {
            bool is_header = false;
            columns = columns_of(fields, lines, is_header);
            count = fields.size();
            if (is_header) continue;
        }
        if (fields.size() != count)
            lines.refuse("columns", fmt::format("{}, as before", count), fmt::format("{}", fields.size()));
        if (columns->operation) {
            const std::string_view op = fields[*columns->operation];
            if (op == "W" || op == "w" || op == "write" || op == "set" || op == "1") {
                ++found.writes;
                continue;
            }
        }
        const auto address = number(fields[columns->address], 10);
        if (!address)
            lines.refuse("address", "a decimal number, or a hexadecimal one behind 0x", fields[columns->address]);
        std::optional<std::uint64_t> size = bytes;
        if (columns->size) size = number(fields[*columns->size], 10);
        if (!size) lines.refuse("size", "a number of bytes", fields[*columns->size]);
        check_end(*address, *size, lines);
        ++found.reads;
        use(*address, *size);
    }
}

void read_u64(const std::string& path, std::uint64_t bytes, const Use& use, AddressStream& found) {
    ByteSource source(path);
    std::string text;
    for (std::size_t at = 0;;) {
        for (; text.size() - at >= sizeof(std::uint64_t); at += sizeof(std::uint64_t)) {
            const auto address = load<std::uint64_t>(reinterpret_cast<const std::uint8_t*>(text.data()) + at);
            if (bytes - 1 > ~std::uint64_t{0} - address)
                throw Error(
                    fmt::format("{}: address {}: expected {} bytes that end below 2^64, found {:#x}; write the "
                                "trace again",
                                path, found.reads, bytes, address));
            ++found.reads;
            use(address, bytes);
        }
        text.erase(0, at);
        at = 0;
        if (source.read(text)) continue;
        if (text.empty()) return;
        throw Error(
            fmt::format("{}: end of the file: expected whole addresses of 8 bytes, found {} bytes more; copy "
                        "the file again, or choose another --format",
                        path, text.size()));
    }
}

}  // namespace

AddressStream read_addresses(const std::string& path, AddressFormat format, std::uint32_t bytes, const Use& use) {
    AddressStream found;
    if (format == AddressFormat::u64) {
        read_u64(path, bytes, use, found);
        return found;
    }
    TextLines lines(path);
    (format == AddressFormat::dinero ? read_dinero : read_csv)(lines, bytes, use, found);
    return found;
}

}  // namespace raycache::traces
