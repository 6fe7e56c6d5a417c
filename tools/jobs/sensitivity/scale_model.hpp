// A scale model of a GPU: some of its SMs, with their share of what all SMs share. It replays a fraction of the warps in
// a fraction of the time, and is asked how a value changes a speed-up, not how fast the GPU is. Shrinking shared
// resources in proportion is what scale models of GPUs do (SeyyedAghaei, Naderan-Tahan & Eeckhout, "GPU Scale-Model
// Simulation", HPCA 2024; recalled).
#pragma once

#include <cstdint>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::tools {

/// The GPU to be replayed, and how many SMs the GPU has that it stands for.
struct ModelledGpu {
    cachesim::Gpu gpu;
    std::uint32_t all_sms = 0;
};

ModelledGpu whole_gpu(const cachesim::Gpu&);

/// `sms` of the SMs. The last level's slices and DRAM's channels are as many as their share, rounded, at least one;
/// ways, bytes a cycle and miss registers of a slice make up for the rounding, so capacity and bandwidth are in
/// proportion but for whole numbers. A hash that asks for another number of slices becomes an exclusive-or of address
/// bits. The GPU has two levels and [timing]. sms >= that of the GPU: the whole GPU.
ModelledGpu scale_model(const cachesim::Gpu&, std::uint32_t sms);

/// The CTA of a launch that the model's CTA number `cta` stands for, both counted from any place: an SM of the model is
/// dealt what one of the GPU's SMs is dealt.
std::int64_t cta_of_launch(std::int64_t cta, const ModelledGpu&);

}  // namespace raycache::tools
