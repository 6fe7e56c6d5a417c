#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <thread>

#include "files.hpp"
#include "samples.hpp"
#include "traces/output_file.hpp"
#include "traces/reader.hpp"
#include "traces/writer.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

/// No file may grow beyond a size while the object lives: what a full disk does.
class FullDisk {
public:
    explicit FullDisk(rlim_t bytes) {
        previous_ = std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &limit_);
        const rlimit lower{bytes, limit_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &lower);
    }
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &limit_);
        std::signal(SIGXFSZ, previous_);
    }

private:
    rlimit limit_{};
    void (*previous_)(int) = nullptr;
};

/// Sorted.
std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}
std::vector<std::string> names_in(const TemporaryFolder& folder) { return names_in(folder.path()); }

Block block_of(const Sample& sample, std::size_t first, std::size_t warps) {
    return encode_block(sample.header, std::span(sample.warps).subspan(first, warps));
}

}  // namespace

TEST_CASE("a trace appears under its name only when it is finished") {
    const TemporaryFolder folder;
    const std::string path = folder / "t.rct";
    const Sample sample = bvh_walks({});
    {
        Writer writer(path, sample.header);
        writer.append(block_of(sample, 0, 5));
        CHECK(!std::filesystem::exists(path));
    }
    CHECK(std::filesystem::is_empty(folder.path()));
    write_sample(sample, path);
    CHECK(names_in(folder) == std::vector<std::string>{"t.rct"});
}

TEST_CASE("blocks out of order, twice or with a gap are refused") {
    const TemporaryFolder folder;
    const Sample sample = bvh_walks({});
    Writer writer(folder / "t.rct", sample.header);
    CHECK_THAT(refusal([&] { writer.append(block_of(sample, 2, 2)); }),
               Contains("expected launch 0 from warp 0, found"));
    writer.append(block_of(sample, 0, 2));
    CHECK_THAT(refusal([&] { writer.append(block_of(sample, 0, 2)); }),
               Contains("expected launch 0 from warp 2, found"));
    CHECK_THAT(refusal([&] { writer.append(block_of(sample, 5, 2)); }), Contains("in order of launch and warp"));
}

TEST_CASE("a trace with missing warps is not finished") {
    const TemporaryFolder folder;
    const Sample sample = bvh_walks({});
    {
        Writer writer(folder / "t.rct", sample.header);
        writer.append(block_of(sample, 0, 5));
        CHECK_THAT(refusal([&] { writer.finish(); }),
                   Contains("expected every warp of every launch, found none for launch 1 warp 0"));
    }
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a full disk is one clear line and leaves no file") {
    const TemporaryFolder folder;
    const Sample sample = bvh_walks({2, 2, 3000, 2, 40});
    std::string message;
    {
        const FullDisk disk(20000);
        message = refusal([&] { write_sample(sample, folder / "t.rct", 4); });
    }
    CHECK_THAT(message, Contains("t.rct: offset") && Contains("File too large") && Contains("free some space"));
    CHECK(message.find('\n') == std::string::npos);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a disk that is full only when the file is closed is noticed") {
    const TemporaryFolder folder;
    std::string message;
    {
        const FullDisk disk(10);
        message = refusal([&] {
            OutputFile file(folder / "note.txt");
            file.write("more than ten bytes");
            file.commit();
        });
    }
    CHECK_THAT(message, Contains("File too large"));
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a folder that does not exist is named") {
    CHECK_THAT(refusal([] { OutputFile("/nowhere/at/all.csv"); }),
               Contains("/nowhere/at/all.csv") && Contains("No such file or directory"));
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "taken");
    CHECK_THAT(refusal([&] { OutputFile(folder / "taken"); }), Contains("taken") && Contains("Is a directory"));
    CHECK(names_in(folder) == std::vector<std::string>{"taken"});
}

TEST_CASE("an output that is a link stays one: what it leads to is replaced") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "far");
    write_file(folder / "far/there.txt", {'o', 'l', 'd'});
    std::filesystem::create_symlink("far/there.txt", folder / "near.txt");
    std::filesystem::create_symlink("near.txt", folder / "nearer.txt");
    std::filesystem::create_symlink("far/new.txt", folder / "dangling.txt");
    for (const auto& [link, target] : {std::pair{"nearer.txt", "far/there.txt"}, {"dangling.txt", "far/new.txt"}}) {
        OutputFile file(folder / link);
        file.write("new");
        const auto written = names_in(folder / "far");
        CHECK(std::any_of(written.begin(), written.end(), [&, to = std::filesystem::path(target)](const auto& name) {
            return name.starts_with(to.filename().string() + ".") && name.ends_with(".partial");
        }));
        file.commit();
        CHECK(std::filesystem::is_symlink(folder / link));
        CHECK(read_file(folder / target) == std::vector<std::uint8_t>{'n', 'e', 'w'});
    }
}

TEST_CASE("a named pipe is written to directly and stays one") {
    const TemporaryFolder folder;
    const std::string pipe = folder / "pipe";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    std::string received;
    std::thread reader([&] { std::getline(std::ifstream(pipe), received); });
    {
        OutputFile file(pipe);
        file.write("through the pipe\n");
        CHECK(names_in(folder) == std::vector<std::string>{"pipe"});
        file.commit();
    }
    reader.join();
    CHECK(received == "through the pipe");
    CHECK(std::filesystem::is_fifo(pipe));
}

TEST_CASE("records that break the rules are refused before they are written") {
    const Sample good = bvh_walks({});
    const auto encode = [&](auto change) {
        Sample bad = good;
        change(bad.warps[1]);
        return refusal([&] { encode_block(bad.header, std::span(bad.warps).first(2)); });
    };
    CHECK_THAT(encode([](WarpTrace& w) { w.records[3].mask = 0; }), Contains("warp 1, record 3") && Contains("mask"));
    CHECK_THAT(encode([](WarpTrace& w) { w.records[3].region = 2; }), Contains("expected a region below 2, found 2"));
    CHECK_THAT(encode([](WarpTrace& w) { w.records[3].reserved = 9; }), Contains("expected reserved 0, found 9"));
    CHECK_THAT(encode([](WarpTrace& w) { w.records[3].ray = RayType(3); }), Contains("ray type below 3"));
    CHECK_THAT(encode([](WarpTrace& w) { w.elements.pop_back(); }), Contains("elements for its masks"));
    CHECK_THAT(encode([](WarpTrace& w) { w.elements[5] = 1u << 30; }), Contains("found one beyond"));
    CHECK_THAT(encode([](WarpTrace& w) { w.warp = 3; }), Contains("expected launch 0 warp 1, found launch 0 warp 3"));
    CHECK_THAT(refusal([&] { encode_block(good.header, {}); }), Contains("expected 1 to"));
}

TEST_CASE("headers that break the rules are refused before a file exists") {
    const TemporaryFolder folder;
    const auto write = [&](auto change) {
        Header header = bvh_walks({}).header;
        change(header);
        return refusal([&] { Writer(folder / "t.rct", header); });
    };
    CHECK_THAT(write([](Header& h) { h.regions.clear(); }), Contains("regions: expected 1 to 254, found 0"));
    CHECK_THAT(write([](Header& h) { h.launches.clear(); }), Contains("launches: expected 1"));
    CHECK_THAT(write([](Header& h) { h.kernels_per_launch = 0; }), Contains("kernels per launch: expected 1 to 1024"));
    CHECK_THAT(write([](Header& h) { h.kernels_per_launch = 2, h.warps_per_launch = 3; }),
               Contains("kernels per launch: expected a divisor of 3 warps per launch, found 2"));
    CHECK_THAT(write([](Header& h) { h.warps_per_launch = 0; }), Contains("warps per launch: expected 1"));
    CHECK_THAT(write([](Header& h) { h.regions[0].base = 64; }), Contains("a multiple of 2 MiB"));
    CHECK_THAT(write([](Header& h) { h.regions[1].stride = 47; }), Contains("stride of region 1: expected 48"));
    CHECK_THAT(write([](Header& h) { h.regions[1].element_size = 0; }), Contains("element size of region 1"));
    CHECK_THAT(write([](Header& h) { h.regions[0].links.pop_back(); }), Contains("links of region 0"));
    CHECK_THAT(write([](Header& h) { h.regions[0].links[1] = 2u << 30; }), Contains("found element 0 of region 2"));
    CHECK_THAT(write([](Header& h) { h.regions[1].count = 1u << 30; }), Contains("count of region 1"));
    CHECK_THAT(write([](Header& h) { h.provenance.scene.assign(1, '\xff'); }), Contains("UTF-8"));
    CHECK(std::filesystem::is_empty(folder.path()));
}
