// Replays of one sample on many GPUs: the times of replay_block(), scale models, and what a replay reads of a GPU.
#include <catch2/catch.hpp>

#include "cachesim/gpus/limits.hpp"
#include "small_jobs.hpp"
#include "tools/jobs/sensitivity/read_values.hpp"
#include "tools/jobs/sensitivity/timed_sample.hpp"
#include "tools/jobs/sensitivity/varied_gpu.hpp"
#include "tools/jobs/sensitivity_job.hpp"
#include "tools/jobs/windows/window_replay.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tools;

namespace {

LaunchSettings launches() {
    LaunchSettings all = test::small_launches({"cranley-patterson", "micro-jitter"});
    all.sampling.resolution = "64x48";
    all.sampling.bounces = 1;
    for (CaseSettings& one : all.cases) one.spp = 32;
    return all;
}

WindowSizes sizes() {
    WindowSizes few;
    few.indices = 2;
    few.work_groups = 8;
    few.windows = few.timed_windows = 2;
    few.sm_windows = 8;
    return few;
}

/// A block of its launches, and the regions it visits.
struct Block {
    WindowedCase of;
    BlockPlan plan;

    explicit Block(const tracer::PreparedScene& scene)
        : of(make_case(scene, strategies_of(launches()).front(), sizes(), 0, 2, 1)),
          plan(of.plan.block(1, of.first[1])) {}
};

std::unique_ptr<tracer::PreparedScene> scene() {
    Observer silent;
    return launches().scene.prepare({}, silent);
}

cachesim::Gpu small_gpu(const std::vector<std::string>& changes = {}) {
    std::vector<std::string> all{"sms=2", "warps_per_cta=2", "max_warps_per_sm=4"};
    all.insert(all.end(), changes.begin(), changes.end());
    return cachesim::load_gpu("rtx-3070", all);
}

}  // namespace

TEST_CASE("a sample in time has the times of a block's windows, whatever is replayed beside it") {
    const auto prepared = scene();
    const Block block(*prepared);
    const std::vector<cachesim::Gpu> gpus{small_gpu(), small_gpu({"timing.l1_latency=90", "warps_per_cta=4"})};
    WindowReplays wanted;
    wanted.timed.resize(1);
    const auto expected =
        replay_block(*block.of.capture, block.of.first_launch(1), block.of.plan, block.plan, sizes(), gpus, wanted);
    const WindowSizes own = sizes();
    const TimedSample sample(block.of, 1, block.plan, own, {whole_gpu(gpus[0]), whole_gpu(gpus[1])});
    for (std::size_t g = 0; g < gpus.size(); ++g) {
        const cachesim::TimedStatistics found = sample.replay(whole_gpu(gpus[g])),
                                        &of_block = expected[g].times.front();
        CHECK(found.cycles == of_block.cycles);
        CHECK(found.cycles > 0);
        CHECK(found.rays == of_block.rays);
        CHECK(found.dram_sectors == of_block.dram_sectors);
        CHECK(found.levels[0] == of_block.levels[0]);
    }
}

TEST_CASE("an SM of a scale model is dealt what one of the GPU's SMs is dealt") {
    ModelledGpu model = whole_gpu(small_gpu());
    for (const std::int64_t cta : {-7, -1, 0, 1, 8}) CHECK(cta_of_launch(cta, model) == cta);
    model.gpu.sms = 2;
    model.all_sms = 6;  // SMs 0 and 3
    std::vector<std::int64_t> dealt;
    for (std::int64_t cta = -3; cta < 5; ++cta) dealt.push_back(cta_of_launch(cta, model));
    CHECK(dealt == std::vector<std::int64_t>{-9, -6, -3, 0, 3, 6, 9, 12});
}

TEST_CASE("a scale model has its share of capacity and bandwidth, and can be replayed") {
    for (const cachesim::GpuPreset& preset : cachesim::gpu_presets()) {
        const cachesim::Gpu gpu = cachesim::load_gpu(preset.name);
        if (gpu.levels.size() > 2) continue;
        for (const std::uint32_t sms : {1u, 2u, 5u, gpu.sms}) {
            CAPTURE(preset.name, sms);
            const ModelledGpu model = scale_model(gpu, sms);
            CHECK(model.all_sms == gpu.sms);
            CHECK(model.gpu.sms == sms);
            const auto problem = cachesim::find_problem(model.gpu);
            CHECK((problem ? problem->key + problem->message : "") == "");
            const double share = static_cast<double>(sms) / gpu.sms;
            const cachesim::CacheGeometry &own = gpu.levels[1], &last = model.gpu.levels[1];
            CHECK(static_cast<double>(last.bytes()) == Approx(share * static_cast<double>(own.bytes())).epsilon(0.25));
            CHECK(model.gpu.timing->l2_bytes_per_cycle * last.slices ==
                  Approx(share * gpu.timing->l2_bytes_per_cycle * own.slices));
            CHECK(model.gpu.timing->dram_gb_s == Approx(share * gpu.timing->dram_gb_s));
            if (sms == gpu.sms) CHECK(model.gpu == gpu);
        }
    }
}

TEST_CASE("values that a replay does not read make no other replay, and all others do") {
    const auto prepared = scene();
    const Block block(*prepared);
    const auto& regions = block.of.capture->header().regions;
    const auto reads = [&](const cachesim::Gpu& one, const cachesim::Gpu& other) {
        return as_replayed(one, regions) != as_replayed(other, regions);
    };
    const WindowSizes own = sizes();
    for (const char* change :
         {"rt_unit.warps=8", "timing.node8_instructions=900", "timing.node4_instructions=900", "l1.seed=9",
          "timing.l1_banks=8", "timing.empty_request_cycles=1", "max_warps_per_sm=6"}) {
        const cachesim::Gpu changed = small_gpu({"warps_per_sm=4", change}), given = small_gpu({"warps_per_sm=4"});
        CAPTURE(change);
        CHECK_FALSE(reads(changed, given));
        const TimedSample sample(block.of, 1, block.plan, own, {whole_gpu(given), whole_gpu(changed)});
        CHECK(sample.replay(whole_gpu(changed)).cycles == sample.replay(whole_gpu(given)).cycles);
    }
    for (const char* change :
         {"timing.node_instructions=90", "l1.policy=fifo", "timing.dram_gb_s=200", "l2.index=modulo"})
        CHECK(reads(small_gpu({change}), small_gpu()));
    CHECK(reads(small_gpu({"timing.empty_request_cycles=1", "front_end.lanes_per_request_16=2"}),
                small_gpu({"front_end.lanes_per_request_16=2"})));
}

TEST_CASE("points of a GPU are its open values one by one and a hypercube of all, equal replays made once") {
    const auto prepared = scene();
    VariedGpu gpu("gtx-980-ti", {"l1.policy=lru"});
    gpu.vary(Block(*prepared).of.capture->header().regions, {8, 1, 0});
    CHECK(gpu.hypercube().size() == 8);
    CHECK(gpu.one_by_one().size() > gpu.open().size());
    for (const cachesim::GpuValue& value : gpu.open()) CHECK(value.key != "l1.policy");
    CHECK(std::count(gpu.unread().begin(), gpu.unread().end(), "timing.node8_instructions") == 1);
    CHECK(gpu.models().size() == 1 + gpu.one_by_one().size() + gpu.hypercube().size());
    CHECK(gpu.reference() == 0);
    gpu.vary(Block(*prepared).of.capture->header().regions, {8, 1, 2});
    CHECK(gpu.reference() == 1);
    CHECK(gpu.models()[0].gpu.sms == 22);
    CHECK(gpu.models()[1].gpu.sms == 2);
}

TEST_CASE("settings of a sensitivity that make no sense are refused") {
    SensitivityJob job;
    job.launches = launches();
    job.gpus = {"rtx-3070"};
    CHECK_NOTHROW(job.check());
    const auto refused = [&](const auto& change) {
        SensitivityJob other = job;
        change(other);
        CHECK_THROWS_AS(other.check(), UsageError);
    };
    refused([](SensitivityJob& j) { j.gpus.clear(); });
    refused([](SensitivityJob& j) { j.gpus = {"rtx-3070", "rtx-3070"}; });
    refused([](SensitivityJob& j) { j.windows = 1; });
    refused([](SensitivityJob& j) { j.varied_windows = 17; });
    refused([](SensitivityJob& j) { j.launches.cases.pop_back(); });
    refused([](SensitivityJob& j) { j.changes = {"l1.ways=64,128"}; });
    refused([](SensitivityJob& j) { j.whole_launches = true, j.variations.sms = 2; });
    job.gpus = {"xeon-8380"};
    Observer silent;
    CHECK_THROWS_WITH(run(job, silent), Catch::Contains("not predicted"));
}
