// What a person who mistyped a name probably meant.
#pragma once

#include <string>
#include <vector>

namespace raycache {

/// The least number of single letters to insert, remove, replace or swap with their neighbour that turns one text into
/// the other (optimal string alignment distance, Damerau 1964). Letters of either case are equal, '_' is '-'.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The one of `valid` that `found` is closest to, if that is close enough to be meant; else one that it is a part of,
/// or that is a part of it; else empty.
std::string closest_name(const std::string& found, const std::vector<std::string>& valid);

/// "; did you mean 'X'?", or nothing.
std::string did_you_mean(const std::string& found, const std::vector<std::string>& valid);

}  // namespace raycache
