// Whether one value of a GPU is what its row in the tables of keys allows. What values ask of each other: limits.hpp.
#pragma once

#include <optional>
#include <string>

#include "cachesim/gpus/key.hpp"
#include "cachesim/gpus/limits.hpp"

namespace raycache::cachesim {

/// What is wrong with it, if anything. `section`: "", "timing.". Of the structs of key_tables.hpp.
template <class Struct>
std::optional<GpuProblem> find_value_problem(const Key<Struct>&, const Struct& of, const std::string& section);

}  // namespace raycache::cachesim
