// Which level of accuracy a speed-up was predicted at, chosen by a pilot, and why.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"

namespace raycache::cachesim {

struct FidelityChoice {
    /// A way to the answer that was weighed.
    struct Level {
        std::string name;                            ///< "functional", "two-phase", "timed", "exact"
        std::uint32_t timed_blocks = 0, blocks = 0;  ///< in all, the pilot's included; 0: whole replay
        double seconds = 0;                          ///< of CPU, as modelled, beyond the pilot's
        bool suffices = false;                       ///< is expected to reach the target
    };
    /// What the pilot measured of one strategy on one GPU.
    struct Pilot {
        std::string strategy, gpu;
        std::uint64_t spp = 0;
        Estimate by_work, by_time, difference;  ///< TwoPhaseSpeedUp
    };
    std::string picked;  ///< name of a level
    std::string reason;  ///< a sentence
    double target = 0;   ///< of the half width over the speed-up
    std::uint32_t pilot_blocks = 0;
    double pilot_seconds = 0;  ///< of CPU, as modelled
    std::vector<Level> levels;
    std::vector<Pilot> pilots;  ///< none where no pilot was needed
};

/// What was picked and why, with tables of the pilot and the levels.
std::string to_text(const FidelityChoice&, std::size_t width);
/// The value of "fidelity".
nlohmann::ordered_json to_json_value(const FidelityChoice&);

}  // namespace raycache::cachesim
