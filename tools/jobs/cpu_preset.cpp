#include "tools/jobs/cpu_preset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/jobs/memory_timing.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tools {
namespace {

constexpr std::uint32_t usual_line = 64;
constexpr unsigned usual_ways = 16;

std::uint32_t line_of(const CpuCache& cache) { return cache.line_bytes != 0 ? cache.line_bytes : usual_line; }

/// In TOML, in double quotes.
std::string quoted(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return '"' + out + '"';
}

class Writer {
public:
    void section(const std::string& name, const std::string& comment) {
        text_ += fmt::format("\n# {}\n[{}]\n", comment, name);
    }
    void plain(const std::string& key, const std::string& value) {
        text_ += fmt::format("{} = {}\n", key, quoted(value));
    }
    void number(const std::string& key, std::uint64_t value, const std::string& source) {
        text_ += fmt::format("{} = {{ value = {}, source = {} }}\n", key, value, quoted(source));
    }
    void real(const std::string& key, double value, const std::string& source) {
        text_ += fmt::format("{} = {{ value = {:.1f}, source = {} }}\n", key, value, quoted(source));
    }
    void word(const std::string& key, const std::string& value, const std::string& source) {
        text_ += fmt::format("{} = {{ value = {}, source = {} }}\n", key, quoted(value), quoted(source));
    }
    const std::string& text() const { return text_; }

private:
    std::string text_ =
        "# Every value is `{ value = …, source = \"…\" }`, written by `raycache measure --preset`. A source that "
        "begins with\n"
        "# \"assumed\" was neither told by the system nor measured. A processor is a GPU here: a core is an SM, a "
        "thread of it\n"
        "# a resident warp, whose 32 lanes run as vectors of simd_width; a line is one sector.\n";
};

void write_cache(Writer& out, const CpuCache& cache, std::uint64_t bytes, const std::string& bytes_source) {
    const std::uint64_t ways = cache.ways != 0 ? cache.ways : usual_ways;
    const std::uint32_t line = line_of(cache);
    const std::string ways_source = cache.ways != 0 ? cache.source : "assumed: 16 ways, not told by the system";
    const std::string line_source = cache.line_bytes != 0 ? cache.source : "assumed: 64 B, not told by the system";
    const bool last = cache.level == 3;
    out.section(fmt::format("l{}", cache.level), size_text(bytes));
    out.number("sets", std::max<std::uint64_t>(1, bytes / (ways * line)), bytes_source + ", over ways and line");
    out.number("ways", ways, ways_source);
    out.number("line_bytes", line, line_source);
    out.number("sector_bytes", line, "assumed: lines are filled whole");
    out.word("index", "modulo", "assumed: the address bits above those of the line");
    out.word("policy", last ? "lru" : "tree_plru",
             last ? "assumed: least recently used; the real policy is not published"
                  : "assumed: tree pseudo-LRU, the usual approximation of LRU in processors");
}

std::uint64_t cycles(double ns, const CpuTimings& t) {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(ns * t.mhz * 1e-3)));
}

void write_timing(Writer& out, const CpuTopology& topology, const CpuTimings& t, const std::string& measured) {
    const bool three = topology.caches.size() == 3;
    out.section("timing",
                "A thread waits for the slowest of its lanes, as a warp does; branch prediction and "
                "out-of-order execution beyond a visit are not modelled.");
    out.word("not_predicted", "no branch predictor",
             "docs/measured.md: what was measured here, beside this model of it");
    const std::string chase = measured + ": pointer chase in random order";
    const std::string as_gpus = "assumed: as for GPUs, in vectors";
    const std::string no_limit = "assumed: no limit that matters";
    out.number("clock_mhz", static_cast<std::uint64_t>(std::llround(t.mhz)), measured + ": a chain of additions");
    out.number("schedulers", 1, "assumed: the threads of a core share its ports");
    out.number("node_instructions", 40, as_gpus);
    out.number("triangle_instructions", 60, as_gpus);
    out.number("texel_instructions", 20, as_gpus);
    out.number("shading_instructions", 200, as_gpus);
    out.number("instruction_latency", 4, "assumed: 4 cycles of a floating-point addition or multiplication");
    out.number("dependent_chains", 8, "assumed: two vector ports, out of order");
    out.word("l1_port", "tags", "assumed: lanes in one line are one access");
    out.number("tags_per_cycle", 2, "assumed: two loads a cycle");
    out.number("l1_bytes_per_cycle", 2 * line_of(topology.caches[0]), "assumed: two loads of a line a cycle");
    // Each contains those above it, also where noise says otherwise.
    const std::uint64_t l1 = cycles(t.l1_ns, t), l2 = std::max(l1, cycles(t.l2_ns, t));
    const std::uint64_t l3 = three ? std::max(l2, cycles(t.l3_ns, t)) : l2;
    out.number("l1_latency", l1, chase);
    out.number("l2_latency", l2, chase);
    if (three) out.number("l3_latency", l3, chase);
    out.number("dram_latency", std::max(l3, cycles(t.dram_ns, t)), chase);
    out.number("l1_mshrs", 12, "assumed: 12 line fill buffers");
    out.number("l1_mshr_merges", 64, no_limit);
    out.number("l2_mshrs", 48, "assumed: a queue of 48 requests");
    out.number("l2_mshr_merges", 64, no_limit);
    if (three) {
        out.number("l3_mshrs", 48, "assumed: as many as for an L2");
        out.number("l3_mshr_merges", 64, no_limit);
    }
    const std::string stream = measured + ": one thread reads a buffer in order, 16 B a load";
    out.real("crossbar_bytes_per_cycle", std::max(1.0, (three ? t.l3_gb_s : t.l2_gb_s) / t.mhz * 1e3), stream);
    out.real("l2_bytes_per_cycle", std::max(1.0, t.l2_gb_s / t.mhz * 1e3), stream);
    if (three)
        out.real("l3_bytes_per_cycle", std::max(1.0, topology.cores * t.l3_gb_s / t.mhz * 1e3),
                 stream + "; assumed: all cores at that rate");
    out.number("dram_channels", 1, "assumed: one queue, since the system does not tell the channels");
    out.real("dram_gb_s", std::max(0.1, t.dram_gb_s), measured + ": all threads read buffers in order");
}

/// Measures the clock again, after everything else: latencies are told in its cycles, so one clock must hold for all.
void settle_clock(CpuTimings& t, Observer& observer) {
    const double before = t.mhz, after = measured_mhz();
    t.mhz = std::max(before, after);
    if (std::min(before, after) < 0.95 * t.mhz)
        observer.warn(
            fmt::format("the clock was {:.0f} MHz before the other measurements and {:.0f} after them; the "
                        "latencies hold for neither: measure again when nothing else runs",
                        before, after));
}

}  // namespace

CpuTimings measure_cpu(const CpuTopology& topology, Observer& observer) {
    const bool three = topology.caches.size() == 3;
    const std::uint32_t line = line_of(topology.caches[0]);
    const std::uint64_t l1 = topology.caches[0].bytes, l2 = topology.caches[1].bytes;
    const std::uint64_t last = topology.caches.back().bytes;
    const std::uint64_t most = std::max(4 * l2, std::min<std::uint64_t>(memory_limit() / 2, 1U << 29));
    const std::uint64_t beyond = std::min(4 * last, most);
    const Stage stage(observer, "measure the caches");
    CpuTimings t;
    t.mhz = measured_mhz();
    t.l1_ns = chase_ns(l1 / 2, line);
    t.l2_ns = chase_ns(l2 / 2, line);
    t.l2_gb_s = stream_gb_s(l2 / 2);
    t.dram_ns = chase_ns(beyond, line);
    t.dram_gb_s = stream_all_gb_s(std::min(beyond, most / std::max(1U, topology.cores)));
    if (!three) {
        settle_clock(t, observer);
        return t;
    }
    t.l3_ns = chase_ns(std::min(4 * l2, std::max(last / 2, l2)), line);
    t.l3_gb_s = stream_gb_s(std::min(4 * l2, std::max(last / 2, l2)));
    for (std::uint64_t bytes = 4 * l2; bytes <= std::min(last, most) / 2; bytes *= 2) {
        if (chase_ns(bytes, line) < (t.l3_ns + t.dram_ns) / 2) continue;
        t.l3_bytes = bytes / 2;
        break;
    }
    settle_clock(t, observer);
    return t;
}

std::string cpu_preset(const Machine& machine, const CpuTopology& topology, const CpuTimings& timings,
                       unsigned simd_width, const std::string& date) {
    const std::string measured = "measured here, " + date;
    Writer out;
    out.plain("name", "measured-cpu");
    out.plain("description", fmt::format("{} ({} core{}), measured {}", machine.cpu, topology.cores,
                                         topology.cores == 1 ? "" : "s", date));
    out.number("sms", topology.cores, topology.cores_source);
    out.number("warps_per_sm", topology.core_threads,
               topology.cores_source + "; assumed: each thread has a packet of 32 rays under way");
    out.number("warps_per_cta", 1, "assumed: a thread takes one packet of 32 rays after the other");
    out.number("l1_per_sm", 1, "assumed: one data cache of a core");
    out.number("simd_width", simd_width, "Embree's widest packets on this processor");
    out.section("front_end", "How objects are read.");
    out.number("load_bytes", 4, "assumed: gather instructions, 32 bits per lane");
    for (const CpuCache& cache : topology.caches) {
        const bool smaller = cache.level == 3 && timings.l3_bytes != 0;
        write_cache(out, cache, smaller ? timings.l3_bytes : cache.bytes,
                    smaller
                        ? fmt::format("{}: a pointer chase in twice as much is nearer to DRAM than to L3; {} says {}",
                                      measured, cache.source, size_text(cache.bytes))
                        : cache.source);
    }
    write_timing(out, topology, timings, measured);
    return out.text();
}

}  // namespace raycache::tools
