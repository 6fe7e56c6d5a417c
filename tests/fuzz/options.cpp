// Command lines: one word a line, of any command; read, and made into what would be run. Nothing is loaded or run.
#include <algorithm>
#include <sstream>

#include "tests/fuzz/fuzz.hpp"
#include "tools/program/program.hpp"

using namespace raycache;

namespace {

bool ends_in_digits(const std::string& word, std::size_t count) {
    return word.size() >= count && std::all_of(word.end() - static_cast<std::ptrdiff_t>(count), word.end(),
                                               [](char c) { return c >= '0' && c <= '9'; });
}

/// The star discrepancy of many points takes long.
bool takes_long(const std::vector<std::string>& words) {
    const bool asks = std::any_of(words.begin(), words.end(), [](const auto& w) { return w.ends_with("discrepancy"); });
    return asks && std::any_of(words.begin(), words.end(), [](const auto& w) { return ends_in_digits(w, 4); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
    std::vector<std::string> words;
    for (std::string line; words.size() < 64 && std::getline(lines, line);) {
        const bool file = line.find('/') != std::string::npos || line.find(".toml") != std::string::npos;
        words.push_back(file ? "h100" : line);  // no file is opened
    }
    if (takes_long(words)) return 0;
    fuzz::accepts([&] {
        const tools::Action action = tools::Program().parse(words);
        fuzz::require(action != nullptr, "what reads well can be run");
    });
    return 0;
}
