// The processor as a GPU file: what the system says of it, what is measured, and that the file loads.
#include <catch2/catch.hpp>

#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "cachesim/gpus/gpu.hpp"
#include "tools/jobs/cpu_preset.hpp"
#include "tools/jobs/memory_timing.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tools;
using Catch::Contains;

namespace {

/// What sysfs would say, in a folder of its own.
class Sysfs {
public:
    Sysfs() {
        std::string name = (std::filesystem::temp_directory_path() / "raycache-sysfs-XXXXXX").string();
        root_ = mkdtemp(name.data());
    }
    ~Sysfs() { std::filesystem::remove_all(root_); }
    Sysfs(const Sysfs&) = delete;
    Sysfs& operator=(const Sysfs&) = delete;

    void set(const std::string& path, const std::string& text) const {
        const std::filesystem::path file = root_ / path;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text << '\n';
    }
    void cache(unsigned index, const std::string& type, unsigned level, const std::string& size, unsigned ways) const {
        const std::string folder = "cpu0/cache/index" + std::to_string(index) + '/';
        set(folder + "type", type);
        set(folder + "level", std::to_string(level));
        set(folder + "size", size);
        if (ways != 0) set(folder + "ways_of_associativity", std::to_string(ways));
        set(folder + "coherency_line_size", "64");
    }
    std::string root() const { return root_.string(); }
    std::filesystem::path file(const std::string& name) const { return root_ / name; }

private:
    std::filesystem::path root_;
};

CpuTimings some_timings() {
    CpuTimings t;
    t.mhz = 3000;
    t.l1_ns = 1.34;
    t.l2_ns = 4.7;
    t.l3_ns = 15;
    t.dram_ns = 90;
    t.l2_gb_s = 90;
    t.l3_gb_s = 60;
    t.dram_gb_s = 40;
    return t;
}

void three_levels(const Sysfs& sysfs) {
    sysfs.cache(0, "Data", 1, "48K", 12);
    sysfs.cache(1, "Instruction", 1, "32K", 8);
    sysfs.cache(2, "Unified", 2, "1280K", 20);
    sysfs.cache(3, "Unified", 3, "24576K", 0);
    sysfs.set("online", "0-7,12");
    sysfs.set("cpu0/topology/thread_siblings_list", "0,4");
}

}  // namespace

TEST_CASE("CPU preset: caches, cores and threads are those of sysfs, instruction caches left out") {
    const Sysfs sysfs;
    three_levels(sysfs);
    const CpuTopology found = cpu_topology(sysfs.root());
    REQUIRE(found.caches.size() == 3);
    CHECK(found.caches[0].bytes == 48 << 10);
    CHECK(found.caches[1].ways == 20);
    CHECK(found.caches[2].bytes == 24 << 20);
    CHECK(found.caches[2].ways == 0);
    CHECK(found.caches[2].source == "sysfs");
    CHECK(found.core_threads == 2);
    CHECK(found.cores == 4);  // of nine threads
}

TEST_CASE("CPU preset: a system that says nothing of caches is one clear line") {
    const Sysfs sysfs;
    CHECK_THROWS_WITH(cpu_topology(sysfs.root(), false), Contains(sysfs.root()) && Contains("xeon-8380.toml"));
    sysfs.cache(0, "Data", 1, "48K", 12);
    CHECK_THROWS_AS(cpu_topology(sysfs.root(), false), Error);
}

TEST_CASE("CPU preset: the file loads, and each value says where it is from") {
    const Sysfs sysfs;
    three_levels(sysfs);
    CpuTopology topology = cpu_topology(sysfs.root());
    CpuTimings timings = some_timings();
    timings.l3_bytes = GENERATE(0ULL, 16ULL << 20);
    const bool three = GENERATE(true, false);
    if (!three) topology.caches.pop_back();
    const std::string text = cpu_preset({"A \"CPU\"", 8, "unknown"}, topology, timings, 8, "2026-01-02");
    std::ofstream(sysfs.file("cpu.toml")) << text;
    const cachesim::Gpu gpu = cachesim::load_gpu(sysfs.file("cpu.toml").string());
    CHECK(gpu.sms == 4);
    CHECK(gpu.warps_per_sm == 2);
    CHECK(gpu.simd_width == 8);
    CHECK(gpu.levels.size() == (three ? 3 : 2));
    CHECK(gpu.l1().bytes() == 48 << 10);
    CHECK(gpu.levels[1].bytes() == 1280 << 10);
    if (three) CHECK(gpu.levels[2].bytes() == (timings.l3_bytes != 0 ? timings.l3_bytes : 24ULL << 20));
    REQUIRE(gpu.timing);
    CHECK(gpu.timing->clock_mhz == 3000);
    CHECK(gpu.timing->l1_latency == 4);
    CHECK(gpu.timing->l2_latency == 14);
    CHECK(gpu.timing->dram_latency == 270);
    CHECK(gpu.timing->dram_gb_s == Approx(40));
    CHECK_THAT(text, Contains("measured here, 2026-01-02") && Contains("\"sysfs\"") && Contains("assumed: "));
}

TEST_CASE("CPU preset: latencies that noise has turned round still make a file that loads") {
    const Sysfs sysfs;
    three_levels(sysfs);
    CpuTimings timings = some_timings();
    timings.l2_ns = 1;
    timings.dram_ns = 2;
    std::ofstream(sysfs.file("cpu.toml"))
        << cpu_preset({"CPU", 8, "unknown"}, cpu_topology(sysfs.root()), timings, 8, "2026-01-02");
    CHECK(cachesim::load_gpu(sysfs.file("cpu.toml").string()).timing->dram_latency >= 45);
}

TEST_CASE("CPU preset: a chase through far more than L1 holds takes longer than one in L1") {
    CHECK(measured_mhz() > 50);
    CHECK(chase_ns(16 << 10, 64) < chase_ns(8 << 20, 64));
}
