// The name of a strategy as a user types it and a table prints it: NAME[:PARAMETER=VALUE]…[+ORDER][@MAP][/LAYOUT].
//   NAME    the decorrelation: "micro-jitter"
//   :PARAMETER=VALUE  a parameter of this strategy alone: "micro-jitter:k=1", "scrambling-distance:mu=0.2@rows". So one
//           strategy may stand in a table several times. It rules over the job's other settings.
//   +ORDER  it runs as a wavefront whose rays are sorted so: "micro-jitter+morton"; +wavefront: not sorted
//   @MAP    the thread map: "owen@samples", "micro-jitter+morton@tile"
//   /LAYOUT the BVH lies in memory so: "micro-jitter/cwbvh8"
// What a name does not say, the job's other settings say. Which names there are, the registries know: decorrelations(),
// ray_orders(), thread_maps(), bvh_layouts().
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tracer/simt/execution.hpp"
#include "tracer/simt/thread_map.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

/// Which parts a name may have. '+', '@', '/' or ':' of one that it may not have is a letter of NAME, and so unknown.
struct StrategyParts {
    bool order = true, thread_map = true, layout = true, parameters = true;
};

struct StrategyName {
    std::string decorrelation = "micro-jitter";
    std::optional<std::string> order = {};       ///< of ray_orders(), or "wavefront"
    std::optional<std::string> thread_map = {};  ///< of thread_maps()
    std::optional<std::string> layout = {};      ///< of bvh_layouts()
    std::vector<std::string> parameters = {};    ///< "PARAMETER=VALUE", in the order given

    /// What a trace does not say of the name that it was made by.
    void take_from(const StrategyName& given) {
        thread_map = given.thread_map;
        parameters = given.parameters;
    }

    bool operator==(const StrategyName&) const = default;
};

/// Takes any text apart; to_string() puts it together again.
StrategyName parse_strategy_name(const std::string& text, StrategyParts = {});
std::string to_string(const StrategyName&);

/// Throws UsageError for a part that no registry has, with the valid ones and the closest of them, and for a parameter
/// that the decorrelation does not have or may not have such a value.
void check_strategy_name(const StrategyName&);

/// Of a trace: what tables call it. Its thread map is a column of its own, no part of its name; its layout is, unless it
/// is the default.
StrategyName strategy_name(const traces::Provenance&);

/// A wavefront in the name's order, else `otherwise`.
ExecutionSettings execution_of(const StrategyName&, const ExecutionSettings& otherwise);
/// The name's thread map, else `otherwise` unless empty, else `classes` for a decorrelation with pixel classes and
/// `tile` for others. Throws UsageError for unknown names.
ThreadMap thread_map_of(const StrategyName&, const std::string& otherwise);

}  // namespace raycache::tracer
