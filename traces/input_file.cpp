#include "traces/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace raycache::traces {

InputFile::InputFile(std::string path) : path_(std::move(path)) {
    // Not blocking: a named pipe without a writer would hang here.
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
        const int error = errno;
        if (descriptor_ >= 0) ::close(descriptor_);
        refuse(at(0), "opening the file", "a readable file", fmt::format("\"{}\"", std::strerror(error)),
               "check the name and its permissions");
    }
    if (!S_ISREG(status.st_mode)) {
        ::close(descriptor_);
        refuse(at(0), "opening the file", "an ordinary file", S_ISDIR(status.st_mode) ? "a folder" : "a device or pipe",
               "name a trace file");
    }
    bytes_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read(std::uint64_t offset, std::size_t count, Bytes& out) const {
    out.resize(count);
    for (std::size_t done = 0; done < count;) {
        const ssize_t got = ::pread(descriptor_, out.data() + done, count - done, static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            refuse(at(offset + done), "reading the file", fmt::format("{} more bytes", count - done),
                   got == 0 ? "the end of the file" : fmt::format("\"{}\"", std::strerror(errno)),
                   "check the disk; nothing may change the file while it is read");
        done += static_cast<std::size_t>(got);
    }
}

}  // namespace raycache::traces
