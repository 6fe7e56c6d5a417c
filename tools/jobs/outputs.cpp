#include "tools/jobs/outputs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "traces/error.hpp"
#include "traces/input_pipe.hpp"
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

void check_stdout() {
    const int flags = ::fcntl(STDOUT_FILENO, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
        throw Error("-: expected an open stdout, found a closed one; name a file, or do not close stdout");
}

}  // namespace

void refuse_overwriting(const FileNames& inputs, const FileNames& outputs) {
    for (const std::string& output : outputs) {
        const auto same = identity_of(output);
        if (!same) continue;
        for (const std::string& input : inputs)
            if (identity_of(input) == same)
                throw UsageError(
                    fmt::format("output {}: expected another file than the input {}, found the same one; name another "
                                "output",
                                output, input));
    }
}

void refuse_same_outputs(const FileNames& outputs) {
    std::set<std::string> places;
    std::set<Identity> files;
    for (const std::string& output : outputs) {
        struct stat status {};
        const bool exists = !output.empty() && ::stat(output.c_str(), &status) == 0;
        if (output.empty() || output == "-" || (exists && !S_ISREG(status.st_mode))) continue;
        std::error_code error;
        const std::string place = std::filesystem::weakly_canonical(std::filesystem::absolute(output), error).string();
        const auto identity = identity_of(output);
        if (places.insert(place).second && (!identity || files.insert(*identity).second)) continue;
        throw UsageError(fmt::format(
            "output {}: expected a file for each output, found two outputs in this one; name another", output));
    }
}

void refuse_stdout(const char* option, const std::string& path) {
    if (path != "-") return;
    throw UsageError(fmt::format(
        "{} -: expected the name of a file, found -, stdout, which is for the report; name a file", option));
}

void warn_of_unfinished(const std::string& path, const Say& warn) {
    for (const std::string& name : traces::abandoned_partial_files(path)) {
        const bool trace = path.ends_with(".rct");
        warn(fmt::format("{}: left unfinished by a run that was killed; remove it{}", name,
                         trace ? fmt::format(", or save what is whole: raycache verify {} --recover NEW.rct", name)
                               : std::string()));
    }
}

void check_outputs(const FileNames& outputs, const Say& warn) {
    refuse_same_outputs(outputs);
    for (const std::string& output : outputs) {
        if (output.empty()) continue;
        if (output == "-") {
            check_stdout();
        } else if (traces::is_pipe(output)) {
            traces::open_pipe_for_writing(output);  // stays open: its reader must not see the end before it has begun
        } else {
            const traces::OutputFile probe(output);
            if (!traces::OutputFile::is_direct(output)) warn_of_unfinished(output, warn);
        }
    }
}

void Deliveries::attempt(const std::function<void()>& deliver) {
    try {
        deliver();
    } catch (const Error& e) {
        failures_.emplace_back(e.what());
    }
}

void Deliveries::finish(const Say& say) {
    if (failures_.empty()) return;
    const std::string last = std::move(failures_.back());
    failures_.pop_back();
    for (const std::string& other : failures_) say(other);
    throw Error(last);
}

void write_text(const std::string& path, const std::string& text) {
    traces::OutputFile file(path);
    file.write(text);
    file.commit();
}

}  // namespace raycache::tools
