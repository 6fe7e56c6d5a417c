// An order by chance that is the same on every machine: std::shuffle draws otherwise in every standard library.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace raycache {

/// Every order as likely as another (R. Fisher, F. Yates, 1938; R. Durstenfeld, CACM 7(7), 1964). below(n): a random
/// number of 0 … n-1.
template <class Value, class Below>
void shuffle_by(std::vector<Value>& values, Below&& below) {
    for (std::size_t left = values.size(); left > 1; --left) std::swap(values[left - 1], values[below(left)]);
}

}  // namespace raycache
