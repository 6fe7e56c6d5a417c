// Import of Accel-Sim traces, plain or compressed, and of addresses in every format; what comes out must verify.
#include "tests/fuzz/fuzz.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/addresses/address_stream.hpp"
#include "traces/addresses/guess.hpp"
#include "traces/verify.hpp"

using namespace raycache;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = fuzz::input_file("kernel.traceg", data, size);
    const std::string output = fuzz::input_file("imported.rct", data, 0);
    fuzz::accepts([&] { traces::guess_trace_kind(path); });
    for (const auto fuse : {traces::Fuse::never, traces::Fuse::independent, traces::Fuse::always}) {
        traces::ImportSettings settings;
        settings.fuse = fuse;
        settings.stores = fuse == traces::Fuse::independent;
        settings.traversal = size % 4 == 3;
        settings.program = settings.command = "fuzz";
        if (fuzz::accepts([&] { traces::import_traceg(path, output, settings); })) traces::verify(output);
    }
    for (const auto format : {traces::AddressFormat::dinero, traces::AddressFormat::csv, traces::AddressFormat::u64})
        if (fuzz::accepts([&] { traces::import_addresses(path, output, {format, 1, "fuzz", "fuzz"}); }))
            traces::verify(output);
    return 0;
}
