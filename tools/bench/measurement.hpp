// What programs that measure for docs/ share: words NAME=VALUE, progress on stderr, exit codes.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "tools/jobs/gpu_settings.hpp"
#include "tools/jobs/observer.hpp"
#include "tools/jobs/windows/window_plan.hpp"

namespace raycache::bench {

/// The words of a command line, each of one of the names given.
class NameValues {
public:
    using Use = std::function<void(const std::string&)>;

    /// May stand any number of times.
    void text(const std::string& name, Use use) { uses_[name] = std::move(use); }
    void text(const std::string& name, std::string& value);
    /// 1 to 2^20.
    void count(const std::string& name, std::uint32_t& value);
    void count(const std::string& name, std::uint64_t& value);
    /// gpu, set, l2-kib.
    void gpu(tools::GpuSettings&);
    /// Of one block: indices, work-groups, sm-windows, windows, timed-windows, fill-waves.
    void sizes(tools::WindowSizes&);

    /// Throws UsageError with the usage for a word of no such name.
    void read(int argc, char** argv, const char* usage) const;

private:
    std::map<std::string, Use> uses_;
};

/// Says on stderr what begins and what it is warned of.
class Talking : public tools::Observer {
public:
    void begin(const std::string& stage, std::uint64_t, const std::string&) override;
    void warn(const std::string& line) override;
};

/// main() of such a program: an exception becomes a line "PROGRAM: error: …" and exit code 1, of usage 2.
int measure(const char* program, const std::function<void()>& body);

}  // namespace raycache::bench
