// gpu_micro: micro-benchmarks of a GPU's memory system as JSON.
#include <charconv>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "tools/gpu/micro/micro.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace {

using Json = nlohmann::ordered_json;
using namespace raycache;

constexpr std::string_view help =
    R"(Micro-benchmarks of a GPU's memory system, as JSON, for the values of a GPU file.
Latencies and bandwidths of L1, L2 and DRAM, the edge of L1 and conflicts in it, what a miss fills, what a load of a
warp costs (docs/gpu_package.md).

Usage: gpu_micro [--quick] [--device N] [--help]
  --quick      fewer sizes
  --device N   number of the GPU (0)
)";

gpu::MicroOptions parse(int count, char** words) {
    gpu::MicroOptions options;
    for (int i = 1; i < count; ++i) {
        const std::string_view word = words[i];
        if (word == "--quick") {
            options.quick = true;
        } else if (word == "--device" && i + 1 < count) {
            const std::string_view number = words[++i];
            const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), options.device);
            if (error != std::errc() || end != number.data() + number.size())
                throw UsageError("--device: expected a number, found '" + std::string(number) + "'");
        } else {
            throw UsageError("expected --quick, --device N or --help, found '" + std::string(word) + "'");
        }
    }
    return options;
}

}  // namespace

int main(int count, char** words) {
    const auto fail = [](const std::string& what, int code) {
        std::cerr << "gpu_micro: error: " << printable_line(what) << '\n';
        return code;
    };
    try {
        if (count == 2 && std::string_view(words[1]) == "--help") {
            std::cout << help;
            return 0;
        }
        const gpu::MicroOptions options = parse(count, words);
        const gpu::MicroResult result = gpu::measure(options);
        Json document{{"schema_version", 1}, {"program", "gpu_micro"}, {"quick", options.quick}};
        for (const auto& [key, value] : result.device)
            std::visit([&, &name = key](const auto& v) { document["device"][name] = v; }, value);
        for (const gpu::Series& series : result.series) {
            Json points = Json::array();
            for (const auto& [x, y] : series.points) points.push_back({x, y});
            document["series"].push_back(
                {{"name", series.name}, {"x", series.x}, {"y", series.y}, {"how", series.how}, {"points", points}});
        }
        std::cout << document.dump(1) << std::endl;
        return std::cout ? 0 : fail("stdout: expected to write the result, found it closed or full", 1);
    } catch (const UsageError& e) {
        return fail(e.what(), 2);
    } catch (const std::exception& e) {
        return fail(e.what(), 1);
    }
}
