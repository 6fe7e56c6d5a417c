// Words that a GPU file may have for a key, and what each stands for.
#pragma once

#include <algorithm>
#include <span>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

/// A value's name in the file, and the C++ value that it stands for.
template <class Enum>
struct Choice {
    const char* name;
    Enum value;
};

inline constexpr Choice<SetIndex> set_indices[] = {{"modulo", SetIndex::modulo},
                                                   {"xor_fold", SetIndex::xor_fold},
                                                   {"ipoly", SetIndex::ipoly},
                                                   {"parity", SetIndex::parity}};
inline constexpr Choice<SliceHash> slice_hashes[] = {
    {"modulo", SliceHash::modulo}, {"xor_fold", SliceHash::xor_fold}, {"ipoly", SliceHash::ipoly}};
inline constexpr Choice<Allocate> allocations[] = {{"on_miss", Allocate::on_miss}, {"on_fill", Allocate::on_fill}};
inline constexpr Choice<Scheduler> schedulers[] = {{"loose_round_robin", Scheduler::loose_round_robin},
                                                   {"greedy_then_oldest", Scheduler::greedy_then_oldest}};
inline constexpr Choice<CrossbarQueues> crossbar_queues[] = {{"outputs", CrossbarQueues::outputs},
                                                             {"inputs", CrossbarQueues::inputs}};
inline constexpr Choice<Traversal> traversals[] = {{"software", Traversal::software}, {"rt_unit", Traversal::rt_unit}};
inline constexpr Choice<L1Port> l1_ports[] = {{"tags", L1Port::tags}, {"banks", L1Port::banks}};

/// The name of a value, which must be one of the choices.
template <class Enum>
const char* name_of(std::span<const Choice<Enum>> choices, Enum value) {
    return std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.value == value; })->name;
}

}  // namespace raycache::cachesim
