// The registers of a warp that loads write.
#pragma once

#include <bitset>

namespace raycache::traces {

/// R0 to R254. R255 is RZ, which no one waits for.
using RegisterSet = std::bitset<256>;

}  // namespace raycache::traces
