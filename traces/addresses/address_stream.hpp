// Streams of addresses that other cache simulators read: one access after the other, of one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace raycache::traces {

enum class AddressFormat {
    dinero,  ///< "0 7f5000000040" a line: 0 a read, 1 a write, 2 an instruction fetch; the address in hexadecimal
    /// A header that names a column address, addr, obj or obj_id, and perhaps size or bytes, and op; without a header
    /// the address alone, or the address and the size. Addresses are decimal, or hexadecimal behind 0x.
    csv,
    u64,  ///< addresses of 8 bytes, little-endian
};

struct AddressStream {
    std::uint64_t reads = 0, writes = 0, fetches = 0;  ///< writes and fetches are left out
};

/// Calls use(address, bytes) for every read. `bytes`: of an access where the file does not say it. The file may be
/// compressed (byte_source.hpp). Throws Error at the first line that breaks the format.
AddressStream read_addresses(const std::string& path, AddressFormat, std::uint32_t bytes,
                             const std::function<void(std::uint64_t address, std::uint64_t bytes)>& use);

struct AddressImport {
    AddressFormat format = AddressFormat::dinero;
    std::uint32_t bytes = 1;  ///< 1 to 4096
    std::string program, command;
};

struct ImportedAddresses {
    AddressStream stream;
    std::uint64_t warps = 0;
};

/// Most accesses of a warp: what is longer is cut into several, one after the other.
inline constexpr std::uint64_t most_warp_addresses = std::uint64_t{1} << 22;

/// A trace of warps of one lane. An access of more than 4096 bytes becomes several.
ImportedAddresses import_addresses(const std::string& input, const std::string& output, const AddressImport&);

}  // namespace raycache::traces
