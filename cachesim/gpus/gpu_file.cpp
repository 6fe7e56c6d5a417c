#include "cachesim/gpus/gpu_file.hpp"

#include <set>

#include "cachesim/gpus/limits.hpp"
#include "cachesim/gpus/toml_reader.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

namespace {

constexpr const char* root_keys[] = {"name",          "description", "sms",        "warps_per_sm", "max_warps_per_sm",
                                     "warps_per_cta", "l1_per_sm",   "simd_width", "scheduler",    "registers",
                                     "front_end",     "l1",          "l2",         "l3",           "timing"};
constexpr const char* register_keys[] = {"per_sm", "per_thread", "allocation"};
constexpr const char* front_end_keys[] = {"load_bytes", "lanes_per_request_16", "lanes_per_request_8",
                                          "lanes_per_request_4"};
constexpr const char* cache_keys[] = {
    "sets",     "ways",           "line_bytes", "sector_bytes",     "index",      "index_masks",     "policy",
    "seed",     "slices",         "slice_hash", "interleave_bytes", "slice_bits", "slice_hash_from", "fill_bytes",
    "allocate", "carve_out_bytes"};
constexpr const char* timing_keys[] = {"not_predicted",
                                       "clock_mhz",
                                       "launch_cycles",
                                       "schedulers",
                                       "node_instructions",
                                       "triangle_instructions",
                                       "texel_instructions",
                                       "leaf_instructions",
                                       "shading_instructions",
                                       "instruction_latency",
                                       "instruction_interval",
                                       "dependent_chains",
                                       "accesses_in_flight",
                                       "load_queue",
                                       "operand_collectors",
                                       "answers_per_cycle",
                                       "l1_port",
                                       "l1_banks",
                                       "tags_per_cycle",
                                       "l1_bytes_per_cycle",
                                       "empty_request_cycles",
                                       "l1_latency",
                                       "l2_latency",
                                       "l2_far_latency",
                                       "l3_latency",
                                       "dram_latency",
                                       "l2_partitions",
                                       "l1_mshrs",
                                       "l1_mshr_merges",
                                       "l2_mshrs",
                                       "l2_mshr_merges",
                                       "l3_mshrs",
                                       "l3_mshr_merges",
                                       "crossbar_bytes_per_cycle",
                                       "crossbar_queues",
                                       "l2_bytes_per_cycle",
                                       "l3_bytes_per_cycle",
                                       "dram_channels",
                                       "dram_gb_s",
                                       "dram_bank_bits",
                                       "dram_row_bit",
                                       "dram_mhz",
                                       "dram_rcd",
                                       "dram_rp",
                                       "dram_ras",
                                       "dram_rc",
                                       "dram_rrd"};

constexpr Choice<SetIndex> set_indices[] = {{"modulo", SetIndex::modulo},
                                            {"xor_fold", SetIndex::xor_fold},
                                            {"ipoly", SetIndex::ipoly},
                                            {"parity", SetIndex::parity}};
constexpr Choice<SliceHash> slice_hashes[] = {
    {"modulo", SliceHash::modulo}, {"xor_fold", SliceHash::xor_fold}, {"ipoly", SliceHash::ipoly}};
constexpr Choice<Allocate> allocations[] = {{"on_miss", Allocate::on_miss}, {"on_fill", Allocate::on_fill}};
constexpr Choice<Scheduler> schedulers[] = {{"loose_round_robin", Scheduler::loose_round_robin},
                                            {"greedy_then_oldest", Scheduler::greedy_then_oldest}};
constexpr Choice<CrossbarQueues> crossbar_queues[] = {{"outputs", CrossbarQueues::outputs},
                                                      {"inputs", CrossbarQueues::inputs}};
constexpr Choice<L1Port> l1_ports[] = {{"tags", L1Port::tags}, {"banks", L1Port::banks}};

CacheGeometry read_cache(TomlReader& file, TomlReader::Section section, const std::string& level) {
    CacheGeometry cache;
    cache.sets = section.number<std::uint64_t>("sets");
    cache.ways = section.number<std::uint64_t>("ways");
    cache.line_bytes = section.number<std::uint32_t>("line_bytes");
    cache.sector_bytes = section.number<std::uint32_t>("sector_bytes");
    cache.index = section.choice("index", set_indices);
    cache.policy = section.text("policy");
    cache.seed = section.number_or("seed", cache.seed, true);
    cache.index_masks = section.numbers_or_none<std::uint64_t>("index_masks");
    cache.slices = section.number_or("slices", cache.slices);
    cache.slice_hash = section.choice_or("slice_hash", slice_hashes, cache.slice_hash);
    cache.interleave_bytes = section.number_or("interleave_bytes", std::max(256u, cache.line_bytes));
    cache.slice_bits = section.numbers_or_none<std::uint32_t>("slice_bits");
    cache.slice_hash_from = section.number_or("slice_hash_from", cache.slice_hash_from, true);
    cache.fill_bytes = section.number_or("fill_bytes", cache.sector_bytes);
    cache.allocate = section.choice_or("allocate", allocations, cache.allocate);
    cache.carve_out_bytes = section.number_or("carve_out_bytes", cache.carve_out_bytes, true);
    std::uint64_t way_bytes = std::uint64_t{cache.slices} * cache.line_bytes;
    if (cache.carve_out_bytes == 0 || __builtin_mul_overflow(way_bytes, cache.sets, &way_bytes)) return cache;
    const std::uint64_t taken = cache.carve_out_bytes / way_bytes + (cache.carve_out_bytes % way_bytes != 0);
    if (taken >= cache.ways)
        file.fail_at(
            level + ".carve_out_bytes",
            fmt::format("expected to leave at least one of {} ways of {} bytes, found {} bytes; carve out less",
                        cache.ways, way_bytes, cache.carve_out_bytes));
    cache.ways -= taken;
    return cache;
}

FrontEnd read_front_end(TomlReader::Section section) {
    FrontEnd f;
    f.load_bytes = section.number_or("load_bytes", f.load_bytes);
    f.lanes_per_request_16 = section.number_or("lanes_per_request_16", f.lanes_per_request_16);
    f.lanes_per_request_8 = section.number_or("lanes_per_request_8", f.lanes_per_request_8);
    f.lanes_per_request_4 = section.number_or("lanes_per_request_4", f.lanes_per_request_4);
    return f;
}

Timing read_timing(TomlReader::Section section) {
    Timing t;
    t.not_predicted = section.text_or_none("not_predicted");
    t.clock_mhz = section.positive("clock_mhz");
    t.launch_cycles = section.number_or("launch_cycles", t.launch_cycles, true);
    t.schedulers = section.number<std::uint32_t>("schedulers");
    t.node_instructions = section.number<std::uint32_t>("node_instructions", true);
    t.triangle_instructions = section.number<std::uint32_t>("triangle_instructions", true);
    t.texel_instructions = section.number<std::uint32_t>("texel_instructions", true);
    t.leaf_instructions = section.number_or("leaf_instructions", t.leaf_instructions, true);
    t.shading_instructions = section.number_or("shading_instructions", t.shading_instructions, true);
    t.instruction_latency = section.number<std::uint32_t>("instruction_latency", true);
    t.instruction_interval = section.number_or("instruction_interval", t.instruction_interval);
    t.dependent_chains = section.number_or("dependent_chains", t.dependent_chains);
    t.accesses_in_flight = section.number_or("accesses_in_flight", t.accesses_in_flight);
    t.load_queue = section.number_or("load_queue", t.load_queue);
    t.operand_collectors = section.number_or("operand_collectors", t.operand_collectors, true);
    t.answers_per_cycle = section.number_or("answers_per_cycle", t.answers_per_cycle, true);
    t.l1_port = section.choice_or("l1_port", l1_ports, t.l1_port);
    t.l1_banks = section.number_or("l1_banks", t.l1_banks);
    t.tags_per_cycle = section.number_or("tags_per_cycle", t.tags_per_cycle);
    t.l1_bytes_per_cycle = section.positive_or("l1_bytes_per_cycle", t.l1_bytes_per_cycle);
    t.empty_request_cycles = section.number_or("empty_request_cycles", t.empty_request_cycles, true);
    t.l1_latency = section.number<std::uint32_t>("l1_latency", true);
    t.l2_latency = section.number<std::uint32_t>("l2_latency", true);
    t.l2_far_latency = section.number_or("l2_far_latency", t.l2_latency, true);
    t.l3_latency = section.number_or("l3_latency", t.l3_latency, true);
    t.dram_latency = section.number<std::uint32_t>("dram_latency", true);
    t.l2_partitions = section.number_or("l2_partitions", t.l2_partitions);
    t.l1_mshrs = section.number<std::uint32_t>("l1_mshrs");
    t.l1_mshr_merges = section.number<std::uint32_t>("l1_mshr_merges");
    t.l2_mshrs = section.number<std::uint32_t>("l2_mshrs");
    t.l2_mshr_merges = section.number<std::uint32_t>("l2_mshr_merges");
    t.l3_mshrs = section.number_or("l3_mshrs", t.l3_mshrs);
    t.l3_mshr_merges = section.number_or("l3_mshr_merges", t.l3_mshr_merges);
    t.crossbar_bytes_per_cycle = section.positive("crossbar_bytes_per_cycle");
    t.crossbar_queues = section.choice_or("crossbar_queues", crossbar_queues, t.crossbar_queues);
    t.l2_bytes_per_cycle = section.positive("l2_bytes_per_cycle");
    t.l3_bytes_per_cycle = section.positive_or("l3_bytes_per_cycle", t.l3_bytes_per_cycle);
    t.dram_channels = section.number<std::uint32_t>("dram_channels");
    t.dram_gb_s = section.positive("dram_gb_s");
    t.dram_bank_bits = section.numbers_or_none<std::uint32_t>("dram_bank_bits");
    t.dram_row_bit = section.number_or("dram_row_bit", t.dram_row_bit, true);
    t.dram_mhz = section.positive_or("dram_mhz", t.dram_mhz);
    t.dram_rcd = section.number_or("dram_rcd", t.dram_rcd, true);
    t.dram_rp = section.number_or("dram_rp", t.dram_rp, true);
    t.dram_ras = section.number_or("dram_ras", t.dram_ras, true);
    t.dram_rc = section.number_or("dram_rc", t.dram_rc, true);
    t.dram_rrd = section.number_or("dram_rrd", t.dram_rrd, true);
    return t;
}

/// Resident warps of an SM: given, or as many CTAs as its registers hold.
std::uint32_t read_residency(TomlReader& file, TomlReader::Section& root, const Gpu& gpu) {
    std::uint32_t by_registers = 0;
    if (root.has("registers")) {
        TomlReader::Section section = root.section("registers", register_keys);
        const auto per_sm = section.number<std::uint32_t>("per_sm");
        const auto per_thread = section.number<std::uint32_t>("per_thread");
        const auto allocation = section.number_or("allocation", 256u);
        const std::uint64_t of_warp =
            (std::uint64_t{per_thread} * traces::warp_lanes + allocation - 1) / allocation * allocation;
        std::uint64_t warps = per_sm / of_warp;
        if (gpu.max_warps_per_sm) warps = std::min<std::uint64_t>(warps, gpu.max_warps_per_sm);
        by_registers = static_cast<std::uint32_t>(warps / gpu.warps_per_cta * gpu.warps_per_cta);
        if (by_registers == 0 && !root.has("warps_per_sm"))
            file.fail_at("registers.per_thread",
                         fmt::format("expected a CTA of {} warps to fit an SM, found registers for {}; use fewer "
                                     "registers or a smaller CTA",
                                     gpu.warps_per_cta, warps));
    }
    if (root.has("warps_per_sm") || !by_registers) return root.number<std::uint32_t>("warps_per_sm");
    file.note("warps_per_sm", fmt::format("{}", by_registers), "computed: the CTAs that the registers of an SM hold");
    return by_registers;
}

Gpu read(TomlReader& file) {
    TomlReader::Section root = file.root(root_keys);
    Gpu gpu;
    gpu.name = root.text("name");
    gpu.description = root.text("description");
    gpu.sms = root.number<std::uint32_t>("sms");
    gpu.max_warps_per_sm = root.number_or("max_warps_per_sm", gpu.max_warps_per_sm);
    gpu.warps_per_cta = root.number<std::uint32_t>("warps_per_cta");
    gpu.warps_per_sm = read_residency(file, root, gpu);
    gpu.l1_per_sm = root.number<std::uint32_t>("l1_per_sm");
    gpu.simd_width = root.number_or("simd_width", gpu.simd_width);
    gpu.scheduler = root.choice_or("scheduler", schedulers, gpu.scheduler);
    if (root.has("front_end")) gpu.front_end = read_front_end(root.section("front_end", front_end_keys));
    gpu.levels.clear();
    const std::size_t levels = root.has("l3") ? 3 : 2;
    for (std::size_t level = 1; level <= levels; ++level)
        gpu.levels.push_back(
            read_cache(file, root.section(fmt::format("l{}", level), cache_keys), fmt::format("l{}", level)));
    if (root.has("timing")) gpu.timing = read_timing(root.section("timing", timing_keys));
    if (const auto problem = find_problem(gpu)) file.fail_at(problem->key, problem->message);
    return gpu;
}

/// The values of these keys, as the GPU has them. What has no value of its own, a name, is passed over.
void note_changes(Gpu& gpu, const std::set<std::string>& keys, const std::vector<GpuValue>& values) {
    for (const std::string& key : keys)
        for (const GpuValue& v : values)
            if (v.key == key) gpu.changes.emplace_back(key, v.value);
    if (gpu.changes.empty()) return;
    std::string list;
    for (const auto& [key, value] : gpu.changes) list += fmt::format("{}{}={}", list.empty() ? "" : ", ", key, value);
    gpu.name += fmt::format(" ({})", list);
}

}  // namespace

Gpu parse_gpu(const std::string& toml, const std::string& file, const std::vector<std::string>& changes) {
    TomlReader reader(toml, file);
    std::set<std::string> changed;
    for (const std::string& change : changes) changed.insert(reader.change(change));
    Gpu gpu = read(reader);
    note_changes(gpu, changed, reader.values());
    return gpu;
}

std::vector<GpuValue> parse_gpu_values(const std::string& toml, const std::string& file) {
    TomlReader reader(toml, file);
    read(reader);
    return reader.values();
}

}  // namespace raycache::cachesim
