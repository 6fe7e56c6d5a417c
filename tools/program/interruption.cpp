#include "tools/program/interruption.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "traces/partial_file.hpp"

namespace raycache::tools {
namespace {

struct Advice {
    std::mutex mutex;
    std::string text = "nothing can be resumed: run the same command again";
};
/// Never destroyed: a signal may come while the program ends.
Advice& advice() {
    static Advice& only = *new Advice;
    return only;
}

const char* word_for(int signal) {
    return signal == SIGINT ? "interrupted (SIGINT)" : signal == SIGTERM ? "terminated (SIGTERM)" : "hung up (SIGHUP)";
}

/// "a, b and 20 others"
std::string list(const std::vector<std::string>& names) {
    constexpr std::size_t most = 4;
    std::string text;
    for (std::size_t i = 0; i < names.size() && i < most; ++i) text += (i == 0 ? "" : ", ") + names[i];
    return names.size() > most ? fmt::format("{} and {} others", text, names.size() - most) : text;
}

[[noreturn]] void end_by(int signal) {
    const traces::OutputsLeft left = traces::end_all_outputs();
    std::string text = fmt::format("\nraycache: {}; ", word_for(signal));
    text += left.finished.empty() ? "no file was written" : "whole files: " + list(left.finished);
    if (!left.removed.empty()) text += "; unfinished and removed: " + list(left.removed);
    {
        const std::lock_guard lock(advice().mutex);
        text += "; " + advice().text + "\n";
    }
    if (isatty(STDERR_FILENO) == 0) text.erase(0, 1);
    // Not through stderr's buffer: another thread may hold it.
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    std::signal(signal, SIG_DFL);
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, signal);
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    ::raise(signal);
    ::_exit(128 + signal);
}

void replace_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0) {
            // Reading from the one or writing to the others fails. open() takes the lowest free number: this one.
            [[maybe_unused]] const int opened = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        }
}

}  // namespace

void handle_signals() {
    replace_closed_streams();
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    advice();
    sigset_t handled;
    sigemptyset(&handled);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaddset(&handled, signal);
    }
    // Blocked in every thread that comes; one waits for them, and may do what a signal handler may not.
    pthread_sigmask(SIG_BLOCK, &handled, nullptr);
    try {
        std::thread([handled] {
            int signal = 0;
            if (::sigwait(&handled, &signal) == 0) end_by(signal);
        }).detach();
    } catch (const std::system_error&) {  // no more threads: signals end the program as they always do
        pthread_sigmask(SIG_UNBLOCK, &handled, nullptr);
    }
}

void advise_if_interrupted(std::string text) {
    const std::lock_guard lock(advice().mutex);
    advice().text = std::move(text);
}

}  // namespace raycache::tools
