// zstd frames and XXH3-64 checksums. Internal to traces/.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "traces/bytes.hpp"
#include "traces/fault.hpp"

namespace raycache::traces {

/// How hard to look for repetitions.
enum class Effort {
    entropy,  ///< hardly: Huffman codes only. Symbols repeat by chance; matches among them cost time and bits
    fast,     ///< zstd level 1
    small,    ///< zstd level 3
};

/// Appends one zstd frame that holds `raw` (nothing for no bytes); returns the bytes appended.
std::size_t compress(std::span<const std::uint8_t> raw, Effort, Bytes& out);

/// Refuses a zstd frame that does not say that it holds `size` bytes: to be asked before memory for them is taken.
void check_content_size(std::span<const std::uint8_t> stored, std::uint64_t size, const Origin&);

/// Makes `raw` the content of one zstd frame, `size` bytes, which the caller has bounded. Refuses any other content
/// size before it takes memory for it.
void decompress(std::span<const std::uint8_t> stored, std::uint64_t size, const Origin&, Bytes& raw);

/// Bytes of memory that decompress_pieces() needs for this frame.
std::uint64_t pieces_memory(std::span<const std::uint8_t> stored);

/// Hands the content of one zstd frame to `use` in pieces, from front to back; refuses any other content size.
void decompress_pieces(std::span<const std::uint8_t> stored, std::uint64_t size, const Origin&,
                       const std::function<void(std::span<const std::uint8_t>)>& use);

std::uint64_t checksum(std::span<const std::uint8_t>);

/// Refuses `whole` unless its last 8 bytes are the checksum of the bytes before them.
void check_sealed(std::span<const std::uint8_t> whole, const Origin&, std::string_view what, std::string_view remedy);

/// Appends the checksum of all bytes so far.
void seal(Bytes&);

}  // namespace raycache::traces
