#include "cachesim/replay/timed/miss_registers.hpp"

namespace raycache::cachesim {

MissRegisters::MissRegisters(std::uint32_t count, std::size_t entries) : count_(count), of_entry_(entries, none) {}

void MissRegisters::give_back(std::uint32_t number) {
    std::uint32_t* link = &of_entry_[registers_[number].entry];
    while (*link != number) link = &registers_[*link].next;
    *link = registers_[number].next;
    registers_.give_back(number);
    --taken_;
}

}  // namespace raycache::cachesim
