#include "traces/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "traces/error.hpp"

namespace raycache::traces {
namespace {

constexpr std::string_view stdout_name = "-";

const char* remedy_for(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            return "free some space or name a file on another disk";
        case EPIPE:
            return "keep the program that reads it running to the end";
        case ENOENT:
        case ENOTDIR:
            return "make the folder first, or name another file";
        case ESTALE:
            return "something removed or replaced the unfinished file; run the command again";
        default:
            return "check the folder and its permissions, or name another file";
    }
}

[[noreturn]] void fail(const std::string& path, std::uint64_t offset, const std::string& what, int error) {
    throw Error(fmt::format("{}: offset {}: {}: expected success, found \"{}\"; {}",
                            path == stdout_name ? "stdout" : path, offset, what, std::strerror(error),
                            remedy_for(error)));
}

/// Calls `f`, whose std::system_error becomes an Error.
template <class F>
void explained(const std::string& path, std::uint64_t offset, const char* what, const F& f) {
    try {
        f();
    } catch (const std::system_error& e) {
        fail(path, offset, what, e.code().value());
    }
}

int open_directly(const std::string& path) {
    if (path == stdout_name) return ::dup(STDOUT_FILENO);
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode)) return open_pipe_for_writing(path);
    return ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
}

}  // namespace

int open_pipe_for_writing(const std::string& path, std::chrono::milliseconds patience) {
    constexpr std::chrono::milliseconds pause(20);
    const auto start = std::chrono::steady_clock::now();
    // Without O_NONBLOCK, open() waits for a reader for ever and without a word.
    int descriptor = -1;
    while ((descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK)) < 0 && errno == ENXIO) {
        if (std::chrono::steady_clock::now() - start > patience)
            throw Error(
                fmt::format("{}: opening the named pipe: expected a program that reads it, found none within {} s; "
                            "start that first",
                            path, std::chrono::duration<double>(patience).count()));
        std::this_thread::sleep_for(pause);
    }
    if (descriptor >= 0) ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
    return descriptor;
}

bool OutputFile::is_direct(const std::string& path) {
    struct stat status {};
    return path == stdout_name || (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode));
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
    if (is_direct(path)) {
        const int descriptor = open_directly(path);
        file_ = descriptor < 0 ? nullptr : ::fdopen(descriptor, "wb");
        if (file_ == nullptr) fail(path_, 0, "opening the file", errno);
        return;
    }
    path_ = followed_links(path);
    explained(path_, 0, "creating the file", [&] { partial_ = std::make_unique<PartialFile>(path_); });
    // A descriptor of its own: fclose() must not end the lock that the partial file's has.
    const int descriptor = ::fcntl(partial_->descriptor(), F_DUPFD_CLOEXEC, 0);
    file_ = descriptor < 0 ? nullptr : ::fdopen(descriptor, "wb");
    if (file_ == nullptr) fail(path_, 0, "creating the file", errno);
}

OutputFile::~OutputFile() {
    if (file_ != nullptr) std::fclose(file_);
}

void OutputFile::write(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) return;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
        fail(path_, bytes_, fmt::format("writing {} bytes", bytes.size()), errno);
    bytes_ += bytes.size();
}

void OutputFile::write(std::string_view text) {
    write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void OutputFile::commit() {
    if (std::fflush(file_) != 0) fail(path_, bytes_, "writing the last bytes", errno);
    if (std::fclose(std::exchange(file_, nullptr)) != 0) fail(path_, bytes_, "closing the file", errno);
    if (partial_) explained(path_, bytes_, "giving the whole file its name", [&] { partial_->publish(); });
    partial_.reset();
}

}  // namespace raycache::traces
