// How many load instructions a warp access is, and how many sectors they ask the tag stage for: what profilers count.
//
// An object is read by loads of FrontEnd::load_bytes, or of the next power of two above its size where that is less:
// load k reads its bytes [k * load_bytes, (k + 1) * load_bytes), the last load perhaps fewer. All active lanes do each
// load together, so a visit to a 64 B node is 4 loads. The lanes of one load go to the tag stage in groups of
// neighbours (FrontEnd::lanes_per_request_*); within a group, a sector that several lanes read is asked for once.
//
// Only numbers: the look-ups of the replay are those of the whole visit (coalesce.hpp), where a sector is looked up
// once. A further request for it hits, unless something evicts it between two loads of one visit.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/frontend/region_layout.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

class LoadCounter {
public:
    LoadCounter(const std::vector<traces::Region>&, const FrontEnd&, const LineShape&);

    /// Load instructions that an access to this region is. What a sort moves is no loads.
    std::uint32_t loads(std::size_t region) const { return regions_[region].count; }

    /// Whether the sectors that all of its loads ask for follow from the distinct sectors of the access.
    bool requests_follow(std::size_t region) const { return regions_[region].form == Form::from_sectors; }
    /// Then: of any accesses to the region together.
    std::uint64_t requests(std::size_t region, std::uint64_t sectors) const {
        return (sectors >> regions_[region].sectors_shift) * regions_[region].requests_per_element;
    }
    /// Else. `mask`: the active lanes; `elements`: one index for each, lowest lane first.
    std::uint32_t requests(std::size_t region, std::uint32_t mask, const std::uint32_t* elements) const {
        const Loads& loads = regions_[region];
        if (loads.form == Form::from_elements)
            return distinct(mask, elements, loads.lanes_per_request) * loads.requests_per_element;
        return general(loads, mask, elements);
    }

    /// How many requests the access makes for these sectors of a line if none of them is in the cache: of each sector,
    /// the first load (of the first group of lanes) that reads it fetches it, and the sectors that one load fetches of
    /// one line are one request to the level below. `line`: address of its first byte. Sectors that no lane reads count
    /// for nothing. Not for what a sort moves.
    std::uint32_t line_requests(std::size_t region, std::uint32_t mask, const std::uint32_t* elements,
                                std::uint64_t line, std::uint32_t sectors) const;

private:
    enum class Form {
        /// The whole warp goes together, and no two elements share a sector: the elements are as many as their sectors
        /// over a power of two. Or there is one load, which asks for each sector once.
        from_sectors,
        /// No load straddles sectors, and elements are a sector or more apart: at the same place of two elements, their
        /// loads read two sectors. So each load asks for as many sectors as there are distinct elements. Such are
        /// triangles of 48 B: load k of element i reads in sector floor((48 i + 16 k) / 32), and 48 > 32.
        from_elements,
        general,
    };
    struct Loads {
        Form form = Form::general;
        std::uint32_t count = 0, bytes = 0, last_bytes = 0;  ///< last_bytes: of the last one
        std::uint32_t lanes_per_request = 32;
        std::uint32_t requests_per_element = 0;
        int sectors_shift = 0;  ///< from_sectors: log2 of sectors per element
        traces::Region region;  ///< without links
    };

    static Loads make(const traces::Region&, const FrontEnd&, const LineShape&);

    /// Distinct elements of each group, added up.
    static unsigned distinct(std::uint32_t mask, const std::uint32_t* elements, unsigned lanes_per_request);
    /// By the text above and nothing else.
    unsigned general(const Loads&, std::uint32_t mask, const std::uint32_t* elements) const;

    int sector_shift_;
    std::vector<Loads> regions_;
};

}  // namespace raycache::cachesim
