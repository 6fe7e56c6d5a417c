// traces/read_trace.py was written from FORMAT.md alone; both readers must see the same records.
#include <catch2/catch.hpp>
#include <cstdio>

#include "dump.hpp"
#include "files.hpp"
#include "samples.hpp"
#include "tests/folders.hpp"

namespace {

std::string python_dump(const std::string& path) {
    const std::string command =
        "/usr/bin/python3 " + raycache::test::source_folder() + "traces/read_trace.py '" + path + "' --dump 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string text;
    char buffer[4096];
    while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, size);
    REQUIRE(::pclose(pipe) == 0);
    return text;
}

void check_same(const std::string& path) {
    const std::string cpp = dump_trace(path), python = python_dump(path);
    INFO(path << ": first difference at byte "
              << std::mismatch(cpp.begin(), cpp.end(), python.begin(), python.end()).first - cpp.begin());
    CHECK((cpp == python));
}

}  // namespace

TEST_CASE("the Python reader sees what the C++ reader sees in the golden files") {
    for (const auto& entry :
         std::filesystem::directory_iterator(raycache::test::source_folder() + "traces/golden/good"))
        if (entry.path().extension() == ".rct") check_same(entry.path());
}

TEST_CASE("the Python reader sees what the C++ reader sees in random traces") {
    const TemporaryFolder folder;
    const std::string path = folder / "random.rct";
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        for (const unsigned degree : {2u, 3u, 8u}) {
            write_sample(bvh_walks({seed, degree, 300, 2, 2, seed == 2}), path);
            check_same(path);
        }
        write_sample(noise({seed, 0, 0, 2, 3}), path);
        check_same(path);
        write_sample(wavefront_buffers({seed, 0, 0, 2, 4}), path);
        check_same(path);
        write_sample(texel_reads({seed, 0, 0, 1, 2}), path);
        check_same(path);
    }
}
