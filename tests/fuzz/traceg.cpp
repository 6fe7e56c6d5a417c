// Import of Accel-Sim traces, plain or xz, each load by itself and fused; what comes out must verify.
#include "tests/fuzz/fuzz.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/verify.hpp"

using namespace raycache;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = fuzz::input_file("kernel.traceg", data, size);
    const std::string output = fuzz::input_file("imported.rct", data, 0);
    for (const bool fused : {false, true}) {
        const bool imported = fuzz::accepts([&] { traces::import_traceg(path, output, {fused, "fuzz", "fuzz"}); });
        if (imported) traces::verify(output);
    }
    return 0;
}
