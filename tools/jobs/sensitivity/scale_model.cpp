#include "tools/jobs/sensitivity/scale_model.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace raycache::tools {
namespace {

std::uint32_t at_least_one(double number) { return static_cast<std::uint32_t>(std::max(1LL, std::llround(number))); }

}  // namespace

ModelledGpu whole_gpu(const cachesim::Gpu& gpu) { return {gpu, gpu.sms}; }

ModelledGpu scale_model(const cachesim::Gpu& gpu, std::uint32_t sms) {
    ModelledGpu model = whole_gpu(gpu);
    if (sms >= gpu.sms) return model;
    const double share = static_cast<double>(sms) / gpu.sms;
    model.gpu.sms = sms;
    cachesim::CacheGeometry& last = model.gpu.levels.back();
    cachesim::Timing& t = *model.gpu.timing;
    last.slices = at_least_one(last.slices * share);
    const double of_slice = share * gpu.levels.back().slices / last.slices;  // what one slice stands for
    last.ways = at_least_one(static_cast<double>(last.ways) * of_slice);
    const bool has_polynomial = last.slices == 16 || last.slices == 32 || last.slices == 64;
    if (has_polynomial)
        last.slice_bits.resize(std::min<std::size_t>(last.slice_bits.size(), std::bit_width(last.slices) - 1U));
    if (last.slice_hash == cachesim::SliceHash::ipoly && !has_polynomial) {
        last.slice_hash = cachesim::SliceHash::xor_fold;
        last.interleave_bytes = last.line_bytes;
    }
    t.l2_bytes_per_cycle *= of_slice;
    t.l2_mshrs = at_least_one(t.l2_mshrs * of_slice);
    if (t.l2_partitions > last.slices) {
        t.l2_latency += (t.l2_far_latency - t.l2_latency) * (t.l2_partitions - 1) / t.l2_partitions;
        t.l2_far_latency = t.l2_latency;
        t.l2_partitions = 1;
    }
    t.dram_channels = at_least_one(t.dram_channels * share);
    t.dram_gb_s *= share;
    return model;
}

std::int64_t cta_of_launch(std::int64_t cta, const ModelledGpu& model) {
    const std::int64_t own = model.gpu.sms, all = model.all_sms;
    const std::int64_t round = cta >= 0 ? cta / own : -((own - 1 - cta) / own);
    return round * all + (cta - round * own) * all / own;
}

}  // namespace raycache::tools
