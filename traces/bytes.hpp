// Little-endian integers in byte buffers; reads are bounded. For the file formats of traces/ and tracer/bvh/.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace raycache::traces {

using Bytes = std::vector<std::uint8_t>;

template <std::unsigned_integral T>
T load(const std::uint8_t* p) {
    T value = 0;
    for (unsigned i = 0; i < sizeof(T); ++i) value = static_cast<T>(value | T{p[i]} << (8 * i));
    return value;
}

template <std::unsigned_integral T>
void store(std::uint8_t* p, T value) {
    for (unsigned i = 0; i < sizeof(T); ++i) p[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

void append(Bytes& out, std::span<const std::uint8_t> more);
void append(Bytes& out, std::string_view text);

template <std::unsigned_integral T>
void append(Bytes& out, T value) {
    std::uint8_t bytes[sizeof(T)];
    store(bytes, value);
    append(out, std::span<const std::uint8_t>(bytes));
}

/// Seven bits a byte, lowest first; the top bit of a byte says that another follows.
inline void append_varint(Bytes& out, std::uint32_t value) {
    for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
    out.push_back(static_cast<std::uint8_t>(value));
}

/// Differences of both signs as small unsigned numbers: 0, -1, 1, -2 … become 0, 1, 2, 3 …
inline std::uint32_t zigzag(std::uint32_t difference) { return (difference << 1) ^ (0u - (difference >> 31)); }
inline std::uint32_t unzigzag(std::uint32_t code) { return (code >> 1) ^ (0u - (code & 1)); }

inline bool starts_with(std::span<const std::uint8_t> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char letter, std::uint8_t byte) { return static_cast<std::uint8_t>(letter) == byte; });
}

/// Takes values off the front of a buffer; nothing once it is exhausted.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    template <std::unsigned_integral T>
    std::optional<T> take() {
        if (bytes_.size() < sizeof(T)) return std::nullopt;
        const T value = load<T>(bytes_.data());
        bytes_ = bytes_.subspan(sizeof(T));
        return value;
    }
    std::optional<std::uint32_t> take_varint() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35 && !bytes_.empty(); shift += 7) {
            const std::uint8_t byte = bytes_.front();
            bytes_ = bytes_.subspan(1);
            value |= std::uint64_t{byte & 0x7fu} << shift;
            if (byte < 0x80) return value >> 32 ? std::nullopt : std::optional(static_cast<std::uint32_t>(value));
        }
        return std::nullopt;
    }
    bool empty() const { return bytes_.empty(); }

private:
    std::span<const std::uint8_t> bytes_;
};

}  // namespace raycache::traces
