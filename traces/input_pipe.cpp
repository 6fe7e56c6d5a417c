#include "traces/input_pipe.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "traces/error.hpp"

namespace raycache::traces {

bool is_pipe(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

std::string read_pipe(const std::string& path, std::size_t most, std::chrono::milliseconds patience) {
    constexpr std::chrono::milliseconds pause(20);
    const auto start = std::chrono::steady_clock::now();
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct Close {
        int descriptor;
        ~Close() { ::close(descriptor); }
    } const close{descriptor};
    std::string text;
    std::array<char, 1 << 16> piece;
    bool has_writer = false;
    while (text.size() < most) {
        const ssize_t got =
            descriptor < 0 ? -1 : ::read(descriptor, piece.data(), std::min(piece.size(), most - text.size()));
        if (got > 0) {
            text.append(piece.data(), static_cast<std::size_t>(got));
        } else if (got < 0 && errno == EAGAIN) {  // a writer that has written nothing yet
            has_writer = true;
            pollfd wait{descriptor, POLLIN, 0};
            ::poll(&wait, 1, -1);
        } else if (got < 0 && errno != EINTR) {
            throw Error(fmt::format("{}: expected a pipe that can be read, found \"{}\"; check its permissions", path,
                                    std::strerror(errno)));
        } else if (got == 0) {  // no writer: not yet, or no more
            if (has_writer || !text.empty()) break;
            if (std::chrono::steady_clock::now() - start > patience)
                throw Error(fmt::format(
                    "{}: reading the named pipe: expected a program that writes to it, found none within {:.3g} s; "
                    "start that first, or name a file",
                    path, std::chrono::duration<double>(patience).count()));
            std::this_thread::sleep_for(pause);
        }
    }
    return text;
}

}  // namespace raycache::traces
