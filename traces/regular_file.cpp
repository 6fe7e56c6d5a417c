#include "traces/regular_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache {
namespace {

struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
};

const char* kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    return S_ISSOCK(mode) ? "a socket" : "a device";
}

}  // namespace

std::vector<std::uint8_t> read_regular_file(const std::string& path, const std::string& what, MemoryBudget* budget,
                                            std::uint64_t most) {
    const auto fail = [&](const std::string& expected, const std::string& found, const char* remedy) {
        throw Error(
            printable_line(fmt::format("{}: {}: expected {}, found {}; {}", path, what, expected, found, remedy)));
    };
    // Not blocking: a named pipe without a writer would hang here.
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)};
    struct stat status {};
    if (file.number < 0 || ::fstat(file.number, &status) != 0)
        fail("a file that can be read", errno == ENOENT ? "none" : fmt::format("\"{}\"", std::strerror(errno)),
             "check the path and its permissions");
    if (!S_ISREG(status.st_mode)) fail("an ordinary file", kind_of(status.st_mode), "check the path");
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > most) fail(fmt::format("at most {}", size_text(most)), size_text(size), "check the path, or split it");
    if (budget != nullptr) budget->charge(size, path, what);
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t got = ::read(file.number, bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(fmt::format("{} bytes", size), fmt::format("\"{}\"", std::strerror(errno)), "check the disk");
        if (got == 0)
            fail(fmt::format("{} bytes", size), fmt::format("{}", done), "nothing may change it while it is read");
        done += static_cast<std::size_t>(got);
    }
    return bytes;
}

}  // namespace raycache
