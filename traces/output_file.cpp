#include "traces/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "traces/error.hpp"

namespace raycache::traces {
namespace {

constexpr std::string_view stdout_name = "-";

[[noreturn]] void fail(const std::string& path, std::uint64_t offset, const char* what, int error) {
    const char* remedy = error == ENOSPC || error == EDQUOT || error == EFBIG
                             ? "free some space or name a file on another disk"
                             : "check the folder and its permissions, or name another file";
    throw Error(fmt::format("{}: offset {}: {}: expected success, found \"{}\"; {}",
                            path == stdout_name ? "stdout" : path, offset, what, std::strerror(error), remedy));
}

/// Where the symbolic links of a file's name lead, also if there is no file yet.
std::string followed(std::string path) {
    constexpr int most_links = 40;
    std::error_code error;
    for (int links = 0; links < most_links; ++links) {
        const std::filesystem::path to = std::filesystem::read_symlink(path, error);
        if (error) break;
        path = (std::filesystem::path(path).parent_path() / to).string();
    }
    return path;
}

std::FILE* open_directly(const std::string& path) {
    const int descriptor =
        path == stdout_name ? ::dup(STDOUT_FILENO) : ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    return descriptor < 0 ? nullptr : ::fdopen(descriptor, "wb");
}

}  // namespace

std::string OutputFile::partial_name(const std::string& path) {
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (path == stdout_name || (exists && !S_ISREG(status.st_mode))) return {};
    return followed(path) + ".partial";
}

OutputFile::OutputFile(const std::string& path)
    : partial_(partial_name(path)), path_(partial_.empty() ? path : followed(path)) {
    file_ = partial_.empty() ? open_directly(path_) : std::fopen(partial_.c_str(), "wb");
    if (file_ == nullptr) fail(open_name(), 0, partial_.empty() ? "opening the file" : "creating the file", errno);
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    if (!partial_.empty()) std::remove(partial_.c_str());
}

void OutputFile::write(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) return;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
        fail(open_name(), bytes_, fmt::format("writing {} bytes", bytes.size()).c_str(), errno);
    bytes_ += bytes.size();
}

void OutputFile::write(std::string_view text) {
    write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void OutputFile::commit() {
    if (std::fflush(file_) != 0) fail(open_name(), bytes_, "writing the last bytes", errno);
    if (std::fclose(std::exchange(file_, nullptr)) != 0) {
        const int error = errno;
        if (!partial_.empty()) std::remove(partial_.c_str());
        fail(open_name(), bytes_, "closing the file", error);
    }
    if (!partial_.empty() && std::rename(partial_.c_str(), path_.c_str()) != 0) {
        const int error = errno;
        std::remove(partial_.c_str());
        fail(path_, 0, "giving the file its name", error);
    }
}

}  // namespace raycache::traces
