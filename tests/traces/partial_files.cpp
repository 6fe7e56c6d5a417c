// Files while they are being written: two writers, what is removed under a writer's hands, what a killed run left.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <thread>

#include "files.hpp"
#include "traces/output_file.hpp"
#include "traces/partial_file.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

std::string text_of(const std::string& path) {
    const auto bytes = read_file(path);
    return {bytes.begin(), bytes.end()};
}

std::vector<std::string> partial_files_in(const TemporaryFolder& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        if (entry.path().extension() == ".partial") names.push_back(entry.path().string());
    return names;
}

/// A process that starts a file and is killed.
pid_t die_while_writing(const std::string& path) {
    const pid_t child = ::fork();
    if (child == 0) {
        OutputFile file(path);
        file.write("half a fi");
        ::raise(SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
    return child;
}

}  // namespace

TEST_CASE("two writers of one file have a partial file each, and the last to finish wins with a whole file") {
    const TemporaryFolder folder;
    const std::string path = folder / "t.txt";
    OutputFile first(path), second(path);
    CHECK(partial_files_in(folder).size() == 2);
    first.write("the first ");
    second.write("the second, longer");
    first.write("writer");
    first.commit();
    CHECK(text_of(path) == "the first writer");
    second.commit();
    CHECK(text_of(path) == "the second, longer");
    CHECK(partial_files_in(folder).empty());
}

TEST_CASE("a partial file that was removed or replaced gets no name") {
    for (const bool replaced : {false, true}) {
        const TemporaryFolder folder;
        const std::string path = folder / "t.txt";
        write_file(path, {'o', 'l', 'd'});
        {
            OutputFile file(path);
            file.write("new");
            const std::string partial = partial_files_in(folder).at(0);
            std::filesystem::remove(partial);
            if (replaced) write_file(partial, {'x'});
            CHECK_THAT(refusal([&] { file.commit(); }),
                       Contains(path) && Contains("removed or replaced") && Contains("run the command again"));
        }
        CHECK(text_of(path) == "old");
        CHECK(partial_files_in(folder).size() == (replaced ? 1 : 0));  // what is not ours stays
    }
}

TEST_CASE("what a killed writer left is found, what a living one writes is not") {
    const TemporaryFolder folder;
    const std::string path = folder / "t.txt";
    CHECK(abandoned_partial_files(path).empty());
    const pid_t dead = die_while_writing(path);
    const OutputFile living(path), other(folder / "t.txt.2");
    write_file(folder / "t.txt.partial", {});
    write_file(folder / "t.txt.1-zzzzzzzz.partial", {});
    const auto found = abandoned_partial_files(path);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Contains("t.txt." + std::to_string(dead) + "-"));
    CHECK(!std::filesystem::exists(path));
    std::filesystem::create_symlink("t.txt", folder / "link.txt");
    CHECK(abandoned_partial_files(folder / "link.txt").size() == 1);
}

TEST_CASE("a partial file counts as abandoned although its process number lives again") {
    const TemporaryFolder folder;
    const std::string left = folder / ("t.txt." + std::to_string(::getpid()) + "-01234567.partial");
    write_file(left, {});
    CHECK(abandoned_partial_files(folder / "t.txt").empty());  // so new that its writer may not have locked it yet
    // The time of creation cannot be set back; a lock is what counts for old ones.
    const int descriptor = ::open(left.c_str(), O_WRONLY);
    REQUIRE(::flock(descriptor, LOCK_EX) == 0);
    CHECK(abandoned_partial_files(folder / "t.txt").empty());
    ::close(descriptor);
}

TEST_CASE("a replaced file keeps its permissions, and the longest possible name can be written") {
    const TemporaryFolder folder;
    const std::string path = folder / (std::string(251, 'n') + ".txt");
    write_file(path, {});
    std::filesystem::permissions(path, std::filesystem::perms(0640));
    OutputFile file(path);
    file.write("new");
    file.commit();
    CHECK(text_of(path) == "new");
    CHECK(std::filesystem::status(path).permissions() == std::filesystem::perms(0640));
}

TEST_CASE("a named pipe that nobody reads is refused after a while") {
    const TemporaryFolder folder;
    const std::string pipe = folder / "pipe";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    CHECK_THAT(refusal([&] { open_pipe_for_writing(pipe, std::chrono::milliseconds(40)); }),
               Contains(pipe) && Contains("expected a program that reads it"));
    std::thread late([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        std::ifstream(pipe).get();
    });
    ::close(open_pipe_for_writing(pipe, std::chrono::minutes(1)));
    late.join();
}

TEST_CASE("whoever ends the process removes what is unfinished and knows what is whole") {
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
        OutputFile whole(folder / "whole.txt"), half(folder / "half.txt");
        whole.commit();
        const OutputsLeft left = end_all_outputs();
        const bool right = left.finished.back() == folder / "whole.txt" && left.removed.size() == 1 &&
                           left.removed[0].starts_with(folder / "half.txt.") && partial_files_in(folder).empty();
        ::_exit(right ? 0 : 1);
    }
    int status = 1;
    ::waitpid(child, &status, 0);
    CHECK(status == 0);
    CHECK(std::filesystem::exists(folder / "whole.txt"));
}
