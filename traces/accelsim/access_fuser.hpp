// Loads of a warp as accesses: each by itself, or those of an object that the compiler split as one. Stores are never
// joined, and end what came before. What a warp waits for and issues between the loads of an access stands behind it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "traces/accelsim/traceg_parser.hpp"
#include "traces/loads/load_access.hpp"

namespace raycache::traces {

/// Which consecutive loads of a warp become one access: those of one mask and ascending program counters that read on
/// in each lane where the load before ended, up to 4096 B, and
enum class Fuse {
    never,
    /// all are of 16 B but the last, and no register that one of them writes is read or written by one that follows or
    /// by what stands between them: a warp need not wait there,
    independent,
    always,
};

class AccessFuser {
public:
    explicit AccessFuser(Fuse fuse) : fuse_(fuse) {}

    /// Calls use(warp, access) for accesses that nothing can be added to any more. The load gets the number of its
    /// access in the warp.
    template <class Use>
    void add(std::uint64_t warp, GlobalLoad& load, const Use& use) {
        if (warp != warp_) begin_warp(warp, use);
        add_steps(load.steps);
        if (continues(load)) {
            access_.bytes += load.bytes;
        } else {
            flush(use);
            access_.steps = std::exchange(steps_, {});
            waits_for_last_ = false;
            ++accesses_;
            access_.mask = load.mask;
            access_.bytes = first_bytes_ = load.bytes;
            access_.is_store = load.is_store;
            std::copy(load.addresses.begin(), load.addresses.end(), access_.addresses.begin());
            written_ = {};
        }
        load.number = accesses_ - 1;
        pc_ = load.pc;
        last_bytes_ = load.bytes;
        written_ |= load.written;
        access_.grain = std::min(first_bytes_, access_.bytes & -access_.bytes);
        if (fuse_ == Fuse::never || load.is_store) flush(use);
    }

    /// The warp has no more loads, but these steps.
    template <class Use>
    void end_warp(std::uint64_t warp, const std::vector<LoadStep>& steps, const Use& use) {
        if (warp != warp_) begin_warp(warp, use);
        flush(use);
        add_steps(steps);
        access_.steps = std::exchange(steps_, {});
        use(warp, access_);
        warp_ = no_warp;
    }

    template <class Use>
    void flush(const Use& use) {
        if (access_.mask != 0) use(warp_, access_);
        access_.mask = 0;
    }

private:
    static constexpr std::uint32_t most_bytes = 4096, whole_bytes = 16;
    static constexpr std::uint64_t no_warp = ~std::uint64_t{0};

    template <class Use>
    void begin_warp(std::uint64_t warp, const Use& use) {
        flush(use);
        warp_ = warp;
        accesses_ = 0;
        waits_for_last_ = false;
        steps_.clear();
    }

    /// They come before the next access. Nothing waits twice for an access, of which several loads are waited for.
    void add_steps(const std::vector<LoadStep>& steps) {
        for (LoadStep step : steps) {
            if (step.needs != 0 && step.needs == accesses_ && std::exchange(waits_for_last_, true)) step.needs = 0;
            if (step.needs == 0 && !steps_.empty())
                steps_.back().instructions += step.instructions;
            else
                steps_.push_back({0, step.needs, step.instructions});
        }
    }

    bool continues(const GlobalLoad& load) const {
        if (load.is_store || access_.mask != load.mask || pc_ >= load.pc || access_.bytes + load.bytes > most_bytes)
            return false;
        if (fuse_ == Fuse::independent && (last_bytes_ != whole_bytes || load.bytes > whole_bytes ||
                                           (written_ & (load.read | load.written | load.between)).any()))
            return false;
        return std::equal(load.addresses.begin(), load.addresses.end(), access_.addresses.begin(),
                          [&](std::uint64_t now, std::uint64_t first) {
                              return now - first == access_.bytes && now + (load.bytes - 1) > first;
                          });
    }

    Fuse fuse_;
    LoadAccess access_;
    std::uint64_t warp_ = no_warp, pc_ = 0;           ///< pc_: of its last load
    std::uint32_t first_bytes_ = 0, last_bytes_ = 0;  ///< that its first and last load read
    RegisterSet written_;                             ///< by its loads
    std::uint32_t accesses_ = 0;                      ///< of the warp, with access_
    bool waits_for_last_ = false;                     ///< a step, for access_
    std::vector<IssueStep> steps_;                    ///< since access_
};

}  // namespace raycache::traces
