#include "traces/partial_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <optional>
#include <random>
#include <system_error>
#include <utility>

namespace raycache::traces {
namespace {

constexpr std::string_view ending = ".partial";

/// What this process writes and has written. Never destroyed: a signal may end the process at any time.
struct Journal {
    std::mutex mutex;
    std::vector<std::string> unfinished, finished;
    std::function<void(const std::string&, std::uint64_t)> listener;
};
Journal& journal() {
    static Journal& only = *new Journal;
    return only;
}

[[noreturn]] void fail(int error) { throw std::system_error(error, std::generic_category()); }

/// Of a file's name, as much as leaves room for what follows; a character of UTF-8 is kept whole.
std::string stem_of(const std::string& file) {
    constexpr std::size_t most = 255 - 40;
    if (file.size() <= most) return file;
    std::size_t length = most;
    while (length > 0 && (static_cast<unsigned char>(file[length]) & 0xc0) == 0x80) --length;
    return file.substr(0, length);
}

std::string new_name(const std::string& path) {
    static std::random_device random;
    const std::filesystem::path file(path);
    return (file.parent_path() /
            fmt::format("{}.{}-{:08x}{}", stem_of(file.filename().string()), ::getpid(), random(), ending))
        .string();
}

/// The process that wrote a partial file called `file`, if that is one of a file with this stem.
std::optional<pid_t> writer_of(std::string_view file, std::string_view stem) {
    if (!file.starts_with(stem) || !file.ends_with(ending)) return std::nullopt;
    file.remove_prefix(stem.size());
    if (!file.starts_with('.') || file.size() <= 1 + ending.size()) return std::nullopt;
    const char *at = file.data() + 1, *end = file.data() + file.size() - ending.size();
    pid_t pid = 0;
    const auto [dash, bad_pid] = std::from_chars(at, end, pid);
    if (bad_pid != std::errc{} || end - dash != 9 || *dash != '-') return std::nullopt;
    std::uint32_t number = 0;
    const auto [stop, bad_number] = std::from_chars(dash + 1, end, number, 16);
    if (bad_number != std::errc{} || stop != end || pid <= 0) return std::nullopt;
    return pid;
}

/// A writer has its file locked while it lives. Its process number decides where the file system has no locks, and for
/// a file so new that it may not be locked yet; alone it would not do: another process may have that number by now.
bool is_abandoned(const std::string& name, pid_t writer) {
    constexpr std::time_t surely_locked = 10;  // seconds
    const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    if (descriptor < 0) return false;
    struct stat status {};
    const bool is_file = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
    const bool unlocked = ::flock(descriptor, LOCK_SH | LOCK_NB) == 0;
    const bool no_locks = !unlocked && errno != EWOULDBLOCK;
    ::close(descriptor);
    const bool lives = ::kill(writer, 0) == 0 || errno != ESRCH;
    const bool old = unlocked && std::time(nullptr) - status.st_ctime > surely_locked;
    return is_file && (unlocked || no_locks) && (!lives || old);
}

bool is_file_of(int descriptor, const std::string& name) {
    struct stat mine {
    }, named{};
    return ::fstat(descriptor, &mine) == 0 && ::lstat(name.c_str(), &named) == 0 && mine.st_dev == named.st_dev &&
           mine.st_ino == named.st_ino;
}

/// So that a crash of the machine does not lose the new name. Not every folder can be synchronised.
void synchronise_folder_of(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

PartialFile::PartialFile(std::string path) : path_(std::move(path)) {
    struct stat old {};
    const bool replaces = ::stat(path_.c_str(), &old) == 0;
    if (replaces && ::access(path_.c_str(), W_OK) != 0) fail(errno);
    const std::lock_guard lock(journal().mutex);
    do {
        name_ = new_name(path_);
        descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
    if (descriptor_ < 0) fail(errno);
    journal().unfinished.push_back(name_);
    ::flock(descriptor_, LOCK_EX | LOCK_NB);  // without it, only the process number tells that the writer lives
    if (replaces) ::fchmod(descriptor_, old.st_mode & 0777);
}

PartialFile::~PartialFile() {
    const std::lock_guard lock(journal().mutex);
    if (!published_) {
        if (is_file_of(descriptor_, name_)) ::unlink(name_.c_str());
        std::erase(journal().unfinished, name_);
    }
    ::close(descriptor_);
}

void PartialFile::publish() {
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) fail(errno);
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) fail(errno);
    {
        const std::lock_guard lock(journal().mutex);
        if (!is_file_of(descriptor_, name_)) fail(ESTALE);
        if (::rename(name_.c_str(), path_.c_str()) != 0) fail(errno);
        published_ = true;
        std::erase(journal().unfinished, name_);
        journal().finished.push_back(path_);
    }
    synchronise_folder_of(path_);
    if (journal().listener) journal().listener(path_, static_cast<std::uint64_t>(status.st_size));
}

std::vector<std::string> abandoned_partial_files(const std::string& path) {
    const std::filesystem::path file(followed_links(path)), folder = file.parent_path();
    const std::string stem = stem_of(file.filename().string());
    std::vector<std::string> found;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const auto writer = writer_of(entry->path().filename().string(), stem);
        const std::string name = (folder / entry->path().filename()).string();
        if (writer && is_abandoned(name, *writer)) found.push_back(name);
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::string followed_links(std::string path) {
    constexpr int most_links = 40;
    std::error_code error;
    for (int links = 0; links < most_links; ++links) {
        const std::filesystem::path to = std::filesystem::read_symlink(path, error);
        if (error) break;
        path = (std::filesystem::path(path).parent_path() / to).string();
    }
    return path;
}

void on_published(std::function<void(const std::string&, std::uint64_t)> listener) {
    journal().listener = std::move(listener);
}

OutputsLeft end_all_outputs() {
    journal().mutex.lock();  // for ever
    OutputsLeft left{journal().finished, journal().unfinished};
    for (const std::string& name : left.removed) ::unlink(name.c_str());
    return left;
}

}  // namespace raycache::traces
