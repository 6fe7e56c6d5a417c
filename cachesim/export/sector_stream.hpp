// Sends what one SM's L1s, or L2, are asked during a replay to a text or byte stream.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "cachesim/export/sector_format.hpp"

namespace raycache::cachesim {

class SectorStream final : public RequestSink {
public:
    /// Whom to listen to.
    struct Choice {
        std::optional<std::uint32_t> sm;  ///< this SM's L1s; none: L2
        std::optional<std::uint32_t> l1;  ///< only this L1 of the SM; none: all of them, in the order of the replay
    };

    /// `write` gets the format's head, then the sectors, in pieces of about 64 KiB.
    SectorStream(Choice, const SectorFormat&, std::uint32_t sector_bytes, std::function<void(std::string_view)> write);

    bool wants_l1(std::uint32_t sm) const override { return choice_.sm == sm; }
    bool wants_l2() const override { return !choice_.sm; }
    void l1(const ServedRequest&) override;
    void l2(const ServedRequest& request) override { add(request); }

    /// Writes what is left. Call after Replay::finish().
    void flush();

private:
    /// The sectors of a look-up in ascending order.
    void add(const ServedRequest&);

    Choice choice_;
    const SectorFormat& format_;
    std::uint32_t sector_bytes_;
    std::function<void(std::string_view)> write_;
    std::string pending_;
};

}  // namespace raycache::cachesim
