#include "tracer/scene/gltf_uri.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

namespace raycache::tracer {

namespace {

constexpr std::string_view data_scheme = "data:";

constexpr std::array<std::int8_t, 256> base64_values() {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[static_cast<unsigned char>(digits[i])] = static_cast<std::int8_t>(i);
    return values;
}

std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text) {
    static constexpr auto values = base64_values();
    for (int pad = 0; pad < 2 && text.ends_with('='); ++pad) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const int value = values[static_cast<unsigned char>(c)];
        if (value < 0) return std::nullopt;
        bits = (bits << 6 | static_cast<std::uint32_t>(value)) & 0xFFFFU;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            bytes.push_back(static_cast<std::uint8_t>(bits >> bit_count & 0xFFU));
        }
    }
    return bytes;
}

int hex_value(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::optional<std::string> percent_decode(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '%') {
            if (i + 2 >= text.size()) return std::nullopt;
            const int high = hex_value(text[i + 1]), low = hex_value(text[i + 2]);
            if (high < 0 || low < 0) return std::nullopt;
            c = static_cast<char>(high * 16 + low);
            i += 2;
        }
        if (c == '\0') return std::nullopt;
        result += c;
    }
    return result;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with(data_scheme); }

std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
    const auto comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string_view::npos) return std::nullopt;
    if (!uri.substr(0, comma).ends_with(";base64")) return std::nullopt;
    return decode_base64(uri.substr(comma + 1));
}

UriFile find_uri_file(const std::string& gltf_path, std::string_view uri) {
    UriFile result;
    result.remedy = "export the scene with its files beside it";
    const auto colon = uri.find(':');
    if (uri.empty() || uri.front() == '/' || (colon != std::string_view::npos && colon < uri.find('/'))) return result;
    const auto folder = std::filesystem::path(gltf_path).parent_path();
    const auto decoded = percent_decode(uri);
    const bool backslashes = uri.find('\\') != std::string_view::npos;
    result.remedy = !decoded      ? "its % begins no escape: write %25, or rename the file"
                    : backslashes ? "its backslash is no separator of folders in a URI: write /"
                                  : "";
    const auto with_slashes = [](std::string text) {
        std::replace(text.begin(), text.end(), '\\', '/');
        return text;
    };
    struct Reading {
        std::optional<std::string> name;
        const char* note;
    };
    const Reading readings[] = {
        {decoded, ""},
        {std::string(uri), "is taken as it is, % and all: its escapes name no file"},
        {decoded ? std::optional(with_slashes(*decoded)) : std::nullopt, "has backslashes, read as /"},
        {with_slashes(std::string(uri)), "has backslashes, read as /, and a % that begins no escape"},
    };
    for (const auto& [name, note] : readings) {
        if (!name || name->empty() || name->front() == '/') continue;
        std::error_code error;
        const auto path = folder / *name;
        const bool exists = std::filesystem::exists(path, error);
        if (!exists && (!result.path.empty() || !decoded)) continue;
        result.path = path.string();
        result.exists = exists;
        result.note = exists ? note : "";
        if (exists) break;
    }
    return result;
}

}  // namespace raycache::tracer
