#include "tools/outputs.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <optional>
#include <utility>

#include "traces/error.hpp"
#include "traces/output_file.hpp"

namespace raycache::tools {
namespace {

using Identity = std::pair<dev_t, ino_t>;

/// Of the ordinary file that a name leads to.
std::optional<Identity> identity_of(const std::string& name) {
    struct stat status {};
    if (name.empty() || ::stat(name.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino};
}

}  // namespace

void refuse_overwriting(const FileNames& inputs, const FileNames& outputs) {
    for (const std::string& output : outputs) {
        if (output.empty()) continue;
        for (const std::string& written : {output, traces::OutputFile::partial_name(output)}) {
            const auto same = identity_of(written);
            if (!same) continue;
            for (const std::string& input : inputs)
                if (identity_of(input) == same)
                    throw UsageError(fmt::format(
                        "output {}: expected another file than the input {}, found {}; name another output", output,
                        input, written == output ? "the same one" : written + ", which is written first"));
        }
    }
}

void refuse_stdout(const char* option, const std::string& path) {
    if (path != "-") return;
    throw UsageError(fmt::format(
        "{} -: expected the name of a file, found -, stdout, which is for the report; name a file", option));
}

}  // namespace raycache::tools
