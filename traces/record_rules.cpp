#include "traces/record_rules.hpp"

namespace raycache::traces {

void reject_record(const WarpTrace& warp, std::size_t record, const std::string& what) {
    throw Error(
        fmt::format("trace to be written: launch {}, warp {}, record {}: {}; this is a fault of the program that "
                    "made the records, please report it",
                    warp.launch, warp.warp, record, what));
}

}  // namespace raycache::traces
