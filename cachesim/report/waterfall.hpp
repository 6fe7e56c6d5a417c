// A product of factors as bars on a logarithmic scale, each beginning where the one before it ended.
#pragma once

#include <string>
#include <vector>

namespace raycache::cachesim {

struct WaterfallStep {
    std::string name;
    double factor = 1;      ///< above 0
    bool subtotal = false;  ///< no factor of its own, but a bar from 1 to the product so far
};

/// Lines of at most `columns` characters, each ending in '\n': an axis, then a line for each step with its name, its
/// factor (or the product so far) and its bar. Bars point left where they make the product smaller.
std::string waterfall(const std::vector<WaterfallStep>&, std::size_t columns);

}  // namespace raycache::cachesim
