#include "tracer/png_chunks.hpp"

#include <algorithm>
#include <array>

namespace raycache::tracer {

namespace {

constexpr std::array<std::uint8_t, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::uint32_t ihdr = 0x49484452, iend = 0x49454E44;

constexpr std::array<std::uint32_t, 256> checksum_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        table[i] = i;
        for (int bit = 0; bit < 8; ++bit) table[i] = (table[i] & 1U) != 0 ? table[i] >> 1 ^ 0xEDB88320U : table[i] >> 1;
    }
    return table;
}

/// CRC-32 of ISO 3309, as the PNG specification asks for.
std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
    static constexpr auto table = checksum_table();
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const std::uint8_t byte : bytes) crc = table[(crc ^ byte) & 0xFFU] ^ crc >> 8;
    return ~crc;
}

std::uint32_t big_endian32(std::span<const std::uint8_t> bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

}  // namespace

bool is_whole_png(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < signature.size() || !std::equal(signature.begin(), signature.end(), bytes.begin())) return false;
    bytes = bytes.subspan(signature.size());
    for (bool first = true;; first = false) {
        constexpr std::size_t frame = 12;  // length, type and checksum around the content
        if (bytes.size() < frame) return false;
        const std::size_t length = big_endian32(bytes);
        if (length > bytes.size() - frame) return false;
        const std::uint32_t type = big_endian32(bytes.subspan(4));
        if (first && (type != ihdr || length != 13)) return false;
        if (big_endian32(bytes.subspan(8 + length)) != checksum(bytes.subspan(4, 4 + length))) return false;
        if (type == iend) return true;
        bytes = bytes.subspan(frame + length);
    }
}

}  // namespace raycache::tracer
