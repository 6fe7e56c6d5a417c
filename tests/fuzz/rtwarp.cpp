// Import of RTWARP01 traces, plain or zstd; what comes out must verify.
#include "tests/fuzz/fuzz.hpp"
#include "traces/rtwarp/import.hpp"
#include "traces/verify.hpp"

using namespace raycache;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = fuzz::input_file("trace.rtw", data, size);
    const std::string output = fuzz::input_file("imported.rct", data, 0);
    if (fuzz::accepts([&] { traces::import_rtwarp(path, output, "fuzz", "fuzz"); })) traces::verify(output);
    return 0;
}
