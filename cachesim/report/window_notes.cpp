#include "cachesim/report/window_notes.hpp"

namespace raycache::cachesim {

std::string window_note(const WindowSample& w) {
    if (w.all_indices)
        return fmt::format(
            "the steady state (sample after sample of one picture, caches warm, nothing drained) itself: all {} sample "
            "indices were replayed, so that every ± is 0; the model (docs/accuracy.md) and its assumed "
            "constants are not exact by that",
            w.indices);
    return fmt::format(
        "estimates of the steady state (sample after sample of one picture, caches warm, nothing drained) from {} "
        "blocks of {} sample indices, {} windows each; ± is of which indices and places were drawn, not of the model "
        "(docs/accuracy.md) and its assumed constants",
        w.blocks, w.indices, w.windows);
}

std::string unfilled_note(const std::string& gpus) {
    return fmt::format(
        "{}: the last cache does not fill up, so the scene as seen from here fits in it: DRAM bytes/ray are at most "
        "those shown and fall towards 0 sample after sample; L2->L1 bytes tell strategies apart",
        gpus);
}

}  // namespace raycache::cachesim
