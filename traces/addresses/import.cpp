#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "traces/addresses/address_stream.hpp"
#include "traces/error.hpp"
#include "traces/format.hpp"
#include "traces/loads/load_writer.hpp"

namespace raycache::traces {

ImportedAddresses import_addresses(const std::string& input, const std::string& output, const AddressImport& settings) {
    ImportedAddresses found;
    LoadPass pass;
    pass.file = input;
    pass.kernel = [&](std::size_t) { return LoadKernel{found.warps, 1}; };
    pass.read = [&](std::size_t, const LoadPass::Use& use) {
        LoadAccess access;
        access.mask = 1;
        std::uint64_t count = 0;
        found.stream =
            read_addresses(input, settings.format, settings.bytes, [&](std::uint64_t at, std::uint64_t bytes) {
                for (; bytes > 0; at += access.bytes, bytes -= access.bytes) {
                    access.bytes = static_cast<std::uint32_t>(std::min<std::uint64_t>(bytes, format::max_element_size));
                    access.addresses[0] = at;
                    use(count++ / most_warp_addresses, access);
                }
            });
        if (count == 0)
            throw Error(
                fmt::format("{}: expected reads, found {} writes and {} instruction fetches; choose another file",
                            input, found.stream.writes, found.stream.fetches));
        found.warps = (count + most_warp_addresses - 1) / most_warp_addresses;
    };
    constexpr std::array names{"din", "csv", "u64"};
    Header header;
    header.provenance.program = settings.program;
    header.provenance.command = settings.command;
    header.provenance.decorrelation = std::filesystem::path(input).filename().string();
    header.provenance.scene = fmt::format("{} addresses", names[static_cast<std::size_t>(settings.format)]);
    write_loads(pass, std::move(header), output);
    return found;
}

}  // namespace raycache::traces
