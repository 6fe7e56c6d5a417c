#include "cachesim/replay/hierarchy.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "cachesim/cache/registry.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

/// Enough that an SM finds its L1s in the machine's caches most of the time; few enough that the misses of a window
/// stay there, too.
constexpr std::size_t accesses_per_window = 32768;

LineShape shape_of(const Gpu& gpu) { return {gpu.l1().line_bytes, gpu.l1().sector_bytes}; }

bool is_between_kernels(traces::ObjectKind kind) { return traces::role_of(kind).is_between_kernels; }

}  // namespace

Hierarchy::Hierarchy(const Gpu& gpu, const std::vector<traces::Region>& regions, InstructionSet instructions)
    : gpu_(gpu),
      instructions_(instructions),
      ids_(regions, gpu.l1().line_bytes),
      coalesce_(regions, shape_of(gpu), ids_, instructions),
      count_loads_(regions, gpu.front_end, shape_of(gpu)),
      shared_(gpu.levels.size() - 1),
      first_touches_(gpu.levels.back().line_bytes / gpu.levels.back().sector_bytes),
      tally_(regions),
      misses_(std::clamp<std::size_t>(accesses_per_window / gpu.sms, 8, 2048)) {
    for (std::size_t level = 0; level <= shared_; ++level) {
        const unsigned caches = level == shared_ ? 1 : level == 0 ? gpu.sms * gpu.l1_per_sm : gpu.sms;
        levels_.push_back(make_level(gpu.levels[level], caches, ids_.bound(), instructions));
        find_sets_.emplace_back(gpu.levels[level], ids_, instructions);
        fills_.emplace_back(gpu.levels[level]);
    }
    for (const traces::Region& region : regions) {
        kinds_.push_back(region.kind);
        element_bytes_.push_back(region.element_size);
        if (traces::is_write(region.kind)) write_back_.emplace();
    }
    accesses_.resize(misses_.rounds() * gpu.sms);
    origins_.resize(accesses_.size());
}

void Hierarchy::observe(RequestSink& sink) {
    if (std::any_of(kinds_.begin(), kinds_.end(), is_between_kernels))
        throw Error("trace of a wavefront: expected one of a megakernel, whose requests can be followed");
    sink_ = &sink;
}

/// What a sort moves goes past all levels.
void Hierarchy::pass_all(std::uint32_t group, const traces::Record& record) {
    const std::uint32_t sector = gpu_.l1().sector_bytes, lanes = record.lanes();
    const auto sectors = (lanes * element_bytes_[record.region] + sector - 1) / sector;
    tally_.add_access(group, lanes, sectors);
    tally_.add_passing(shared_, group, sectors);
}

void Hierarchy::end_sm(unsigned sm) {
    if (batch_ == issued_) return;
    lookups_.count = 0;
    coalesce_(std::span(accesses_).subspan(batch_, issued_ - batch_), batch_, lookups_);
    count_accesses();
    if (write_back_) set_writes_apart();
    for (std::size_t level = 0; level < shared_; ++level) look_up(level, lookups_, sm);
    misses_.add(lookups_);
    batch_ = issued_;
}

/// Charges the SM's accesses, whose look-ups are not answered yet.
void Hierarchy::count_accesses() {
    // Look-ups come in order of accesses: of each, how many sectors it and those before ask for.
    sectors_.resize(accesses_.size());
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < lookups_.count; ++i) {
        sum += static_cast<unsigned>(std::popcount(lookups_.sectors[i]));
        sectors_[lookups_.accesses[i]] = sum;
    }
    std::uint32_t before = 0;
    for (std::uint32_t i = batch_; i < issued_; ++i) {
        const WarpAccess& access = accesses_[i];
        const std::uint32_t group = origins_[i].group;
        tally_.add_access(group, access.lanes(), sectors_[i] - before);
        before = sectors_[i];
        if (!count_loads_.requests_follow(access.region)) [[unlikely]]
            tally_.add_requests(group, count_loads_.requests(access.region, access.mask, access.elements));
    }
}

/// Writes go through to the shared level and leave no trace above.
void Hierarchy::set_writes_apart() {
    written_.count = 0;
    written_.reserve(lookups_.count);
    std::size_t reads = 0;
    for (std::size_t i = 0; i < lookups_.count; ++i) {
        const std::uint32_t line = lookups_.lines[i], sectors = lookups_.sectors[i], access = lookups_.accesses[i];
        if (traces::is_write(kinds_[origins_[access].region])) {
            written_.add(line, sectors, access);
            tally_.add_passing(shared_ - 1, origins_[access].group, static_cast<unsigned>(std::popcount(sectors)));
        } else {
            lookups_.lines[reads] = line;
            lookups_.sectors[reads] = sectors;
            lookups_.accesses[reads++] = access;
        }
    }
    lookups_.count = reads;
    misses_.add(written_);  // each access has a round of its own, so the order of reads and writes is kept
}

void Hierarchy::end_window() {
    Lookups& missing = misses_.take([this](std::uint32_t access) { return origins_[access].round; });
    if (write_back_)
        look_up_written(missing);
    else
        look_up(shared_, missing, 0);
    if (sink_) sink_->end_window();
    issued_ = batch_ = 0;
}

void Hierarchy::end_kernel() {
    if (shared_ == 1) levels_[0] = make_level(gpu_.levels[0], gpu_.sms * gpu_.l1_per_sm, ids_.bound(), instructions_);
}

const std::uint32_t* Hierarchy::sets(std::size_t level, const Lookups& lookups, unsigned sm) {
    const auto region_of = [this](std::uint32_t access) { return origins_[access].region; };
    if (level == 0 && gpu_.l1_per_sm > 1)
        return find_sets_[level](lookups, region_of,
                                 [&](std::uint32_t access) { return sm * gpu_.l1_per_sm + origins_[access].l1; });
    return find_sets_[level](lookups, region_of, [sm](std::uint32_t) { return sm; });
}

/// Leaves the look-ups for which the level fetches something, and what that is.
void Hierarchy::look_up(std::size_t level, Lookups& lookups, unsigned sm) {
    const bool observed = sink_ && sink_->wants(level, sm), widens = fills_[level].widens();
    if (observed || widens)
        asked_.assign(lookups.sectors.begin(), lookups.sectors.begin() + static_cast<std::ptrdiff_t>(lookups.count));
    levels_[level]->process(sets(level, lookups, sm), lookups.lines.data(), lookups.sectors.data(), lookups.count);
    if (observed) report(level, lookups, sm);
    if (widens)
        for (std::size_t i = 0; i < lookups.count; ++i)
            tally_.add_unasked(level, origins_[lookups.accesses[i]].group, lookups.sectors[i] & ~asked_[i]);
    lookups.drop_answered(instructions_);
    for (std::size_t i = 0; i < lookups.count; ++i)
        tally_.add_fetched(level, origins_[lookups.accesses[i]].group, lookups.sectors[i]);
    if (level != shared_) return;
    for (std::size_t i = 0; i < lookups.count; ++i)
        tally_.add_first(origins_[lookups.accesses[i]].group, first_touches_.add(lookups.lines[i], lookups.sectors[i]));
}

/// The shared level of a launch that writes: a written sector is there afterwards without being read from DRAM, and is
/// written to DRAM once for each time that it was changed and then evicted (or was left at the end).
void Hierarchy::look_up_written(Lookups& lookups) {
    asked_.assign(lookups.sectors.begin(), lookups.sectors.begin() + static_cast<std::ptrdiff_t>(lookups.count));
    levels_[shared_]->process(sets(shared_, lookups, 0), lookups.lines.data(), lookups.sectors.data(), lookups.count);
    for (std::size_t i = 0; i < lookups.count; ++i) {
        const std::uint32_t line = lookups.lines[i], fetched = lookups.sectors[i];
        const Origin& origin = origins_[lookups.accesses[i]];
        if (traces::is_write(kinds_[origin.region])) {
            tally_.add_fetched(shared_, origin.group, write_back_->write(line, asked_[i], fetched));
            first_touches_.add(line, asked_[i] | fetched);  // there without being read
        } else {
            write_back_->read(line, fetched);
            tally_.add_unasked(shared_, origin.group, fetched & ~asked_[i]);
            tally_.add_fetched(shared_, origin.group, fetched);
            tally_.add_first(origin.group, first_touches_.add(line, fetched));
        }
    }
}

void Hierarchy::report(std::size_t level, const Lookups& answers, unsigned sm) const {
    for (std::size_t i = 0; i < answers.count; ++i) {
        const std::uint32_t access = answers.accesses[i];
        const Origin& origin = origins_[access];
        const Tally::RayOf like = tally_.ray_of(origin.group);
        sink_->served(level, {ids_.line(answers.lines[i], origin.region) * gpu_.l1().line_bytes, asked_[i],
                              answers.sectors[i] & asked_[i], sm, level == 0 ? origin.l1 : 0u, like.ray, like.bounce,
                              kinds_[origin.region], access});
    }
}

}  // namespace raycache::cachesim
