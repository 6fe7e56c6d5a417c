#include "tools/bench/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "tools/jobs/numbers.hpp"
#include "traces/error.hpp"

namespace raycache::bench {
namespace {

std::uint64_t whole(const std::string& value, const std::string& name) {
    return tools::read_whole(value, name, {1, 1U << 20});
}

}  // namespace

void NameValues::text(const std::string& name, std::string& value) {
    uses_[name] = [&value](const std::string& v) { value = v; };
}

void NameValues::count(const std::string& name, std::uint32_t& value) {
    uses_[name] = [&value, name](const std::string& v) { value = static_cast<std::uint32_t>(whole(v, name)); };
}

void NameValues::count(const std::string& name, std::uint64_t& value) {
    uses_[name] = [&value, name](const std::string& v) { value = whole(v, name); };
}

void NameValues::gpu(tools::GpuSettings& gpu) {
    uses_["gpu"] = [&gpu](const std::string& v) { gpu.names = {v}; };
    uses_["set"] = [&gpu](const std::string& v) { gpu.changes.push_back(v); };
    uses_["l2-kib"] = [&gpu](const std::string& v) { gpu.l2_kib = {whole(v, "l2-kib")}; };
}

void NameValues::sizes(tools::WindowSizes& sizes) {
    count("indices", sizes.indices);
    count("work-groups", sizes.work_groups);
    count("sm-windows", sizes.sm_windows);
    count("windows", sizes.windows);
    count("timed-windows", sizes.timed_windows);
    count("fill-waves", sizes.fill_waves);
}

void NameValues::read(int argc, char** argv, const char* usage) const {
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const std::size_t at = std::min(word.find('='), word.size());
        const auto use = uses_.find(word.substr(0, at));
        if (use == uses_.end() || at == word.size())
            throw UsageError(fmt::format("'{}'; expected NAME=VALUE\n{}", word, usage));
        use->second(word.substr(at + 1));
    }
}

void Talking::begin(const std::string& stage, std::uint64_t, const std::string&) {
    fmt::print(stderr, "==> {}\n", stage);
}

void Talking::warn(const std::string& line) { fmt::print(stderr, "{}\n", line); }

int measure(const char* program, const std::function<void()>& body) {
    try {
        body();
    } catch (const UsageError& e) {
        fmt::print(stderr, "{}: error: {}\n", program, e.what());
        return 2;
    } catch (const std::exception& e) {
        fmt::print(stderr, "{}: error: {}\n", program, e.what());
        return 1;
    }
    return 0;
}

}  // namespace raycache::bench
