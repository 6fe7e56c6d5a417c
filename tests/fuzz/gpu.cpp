// GPU files: the first line may be a change as --set takes it, the rest is TOML.
#include <string>
#include <string_view>

#include "cachesim/gpus/gpu_file.hpp"
#include "cachesim/replay/launch_checks.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace raycache;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string text(reinterpret_cast<const char*>(data), size);
    std::vector<std::string> changes;
    constexpr std::string_view mark = "#set ";
    if (text.starts_with(mark)) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        changes.push_back(text.substr(mark.size(), end - mark.size()));
        text.erase(0, end);
    }
    fuzz::accepts([&] {
        const cachesim::Gpu gpu = cachesim::parse_gpu(text, "fuzz.toml", changes);
        fuzz::require(gpu.sms > 0 && (gpu.levels.size() == 2 || gpu.levels.size() == 3), "an accepted GPU has caches");
        if (gpu.timing) cachesim::checked_timed(gpu);
    });
    fuzz::accepts([&] { cachesim::parse_gpu_values(text, "fuzz.toml"); });
    return 0;
}
