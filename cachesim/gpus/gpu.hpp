// A GPU's memory system as the replay needs it, read from a TOML preset in this folder or from a user's file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cachesim/cache/geometry.hpp"
#include "cachesim/gpus/rt_unit_timing.hpp"
#include "cachesim/gpus/timing.hpp"

namespace raycache::cachesim {

/// Which resident warp of an SM issues next, where time says which are ready. A functional replay always takes turns.
enum class Scheduler {
    loose_round_robin,   ///< the next ready warp in slot order
    greedy_then_oldest,  ///< the same warp as long as it is ready, then the one that became resident first
};

/// How a visit to an object becomes load instructions, and these become requests to the tag stage.
struct FrontEnd {
    std::uint32_t load_bytes = 16;  ///< widest load that the compiler emits; objects are read in pieces of this size
    /// Lanes of one load that go to the tag stage together, for loads of 16, 8, and 4 or fewer bytes; 32 = whole warp.
    std::uint32_t lanes_per_request_16 = 32, lanes_per_request_8 = 32, lanes_per_request_4 = 32;

    bool operator==(const FrontEnd&) const = default;
};

struct Gpu {
    std::string name;         ///< "gtx-980-ti"; with what was changed, "gtx-980-ti (l1.ways=64, sms=16)"
    std::string description;  ///< "GeForce GTX 980 Ti (GM200, Maxwell)"
    /// KEY and VALUE of what load_gpu() was told to change, as they stand in the name.
    std::vector<std::pair<std::string, std::string>> changes;
    std::uint32_t sms = 0;
    std::uint32_t warps_per_sm = 0;      ///< resident at once; a multiple of the CTA size is not required
    std::uint32_t max_warps_per_sm = 0;  ///< that an SM can hold, whatever the kernel; 0: not known
    std::uint32_t warps_per_cta = 8;
    std::uint32_t l1_per_sm =
        1;  ///< independent L1s of an SM (Maxwell: 2); its resident warps are dealt out among them
    std::uint32_t simd_width = 32;  ///< lanes that execute together; a warp of 32 runs as 32 / simd_width vectors
    Scheduler scheduler = Scheduler::loose_round_robin;
    FrontEnd front_end;
    /// From L1 to the last level before DRAM, 2 or 3. The last is one for the whole GPU, the others are one for each SM
    /// (L1: l1_per_sm). Line and sector size are the same in all.
    std::vector<CacheGeometry> levels{2};
    std::optional<Timing> timing;  ///< what a timed replay needs
    /// What walks the BVH there; rt_unit asks for an RT unit, which software leaves idle.
    Traversal traversal = Traversal::software;
    std::optional<RtUnitTiming> rt_unit;

    const CacheGeometry& l1() const { return levels.front(); }
    CacheGeometry& l1() { return levels.front(); }
    bool operator==(const Gpu&) const = default;
};

/// A preset's name, or the path of a .toml file (anything with a '/' or ending in ".toml"). `changes`: values that take
/// the place of the file's, "KEY=VALUE" with a value in TOML, such as "l1.ways=64" or "timing.l1_port='banks'". Throws
/// UsageError for an unknown name (listing the valid ones) or a change that is none; Error "FILE:LINE: …" for unknown
/// or missing keys, wrong types, impossible geometry. The changes stand in the GPU's name.
Gpu load_gpu(const std::string& name_or_path, const std::vector<std::string>& changes = {});

/// "CPU time: not predicted for xeon-8380 (…; see cachesim/MODEL.md)" where Timing::not_predicted says why; else empty.
/// Reports print it in place of times and what is computed from them, and leave those out: null in JSON, empty in CSV.
std::string no_time_note(const Gpu&);

/// "software" or "rt_unit", as a GPU file has it.
const char* traversal_name(const Gpu&);

/// Whether load_gpu() takes it for the path of a file.
bool is_gpu_file(const std::string& name_or_path);

struct GpuPreset {
    std::string name, description;
};
/// Presets compiled into the program, sorted by name.
std::vector<GpuPreset> gpu_presets();

/// What a value may be instead, where no one has measured it: `range = [low, high]` or `choices = […]` of a GPU file.
struct GpuRange {
    bool listed = false;              ///< these values alone; else the two ends, and all between them
    std::vector<std::string> values;  ///< as GpuValue::value; the value itself is among or between them
    std::string source;               ///< why these; empty if the file does not say

    /// Whether there is a value but the file's own.
    bool leaves_open() const { return listed ? values.size() > 1 : values.front() != values.back(); }
};

/// One value of a GPU file, as it is written there.
struct GpuValue {
    std::string key;     ///< "sms", "l1.ways"
    std::string value;   ///< "22", "modulo"
    std::string source;  ///< who says so, or "assumed…"; empty if the file gives none
    std::optional<GpuRange> range;
};
/// Every value except name and description, in the order of the fields of Gpu. Takes and throws what load_gpu() does. A
/// value that was changed has neither source nor range.
std::vector<GpuValue> gpu_values(const std::string& name_or_path, const std::vector<std::string>& changes = {});

}  // namespace raycache::cachesim
