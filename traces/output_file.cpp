#include "traces/output_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "traces/error.hpp"

namespace raycache::traces {
namespace {

[[noreturn]] void fail(const std::string& path, std::uint64_t offset, const char* what, int error) {
    const char* remedy = error == ENOSPC || error == EDQUOT || error == EFBIG
                             ? "free some space or name a file on another disk"
                             : "check the folder and its permissions, or name another file";
    throw Error(fmt::format("{}: offset {}: {}: expected success, found \"{}\"; {}", path, offset, what,
                            std::strerror(error), remedy));
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)), partial_(path_ + ".partial") {
    file_ = std::fopen(partial_.c_str(), "wb");
    if (file_ == nullptr) fail(partial_, 0, "creating the file", errno);
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove(partial_.c_str());
}

void OutputFile::write(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) return;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
        fail(partial_, bytes_, fmt::format("writing {} bytes", bytes.size()).c_str(), errno);
    bytes_ += bytes.size();
}

void OutputFile::write(std::string_view text) {
    write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void OutputFile::commit() {
    if (std::fflush(file_) != 0) fail(partial_, bytes_, "writing the last bytes", errno);
    if (std::fclose(std::exchange(file_, nullptr)) != 0) {
        const int error = errno;
        std::remove(partial_.c_str());
        fail(partial_, bytes_, "closing the file", error);
    }
    if (std::rename(partial_.c_str(), path_.c_str()) != 0) {
        const int error = errno;
        std::remove(partial_.c_str());
        fail(path_, 0, "giving the file its name", error);
    }
}

}  // namespace raycache::traces
