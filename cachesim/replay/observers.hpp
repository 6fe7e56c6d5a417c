// All that listen to one replay.
#pragma once

#include <algorithm>
#include <vector>

#include "cachesim/replay/request_sink.hpp"

namespace raycache::cachesim {

class Observers {
public:
    /// The sink must outlive this object.
    void add(RequestSink& sink) {
        sinks_.push_back(&sink);
        any_ = true;
    }

    bool any() const { return any_; }
    bool want(std::size_t level, std::uint32_t sm) const {
        return std::any_of(sinks_.begin(), sinks_.end(),
                           [&](const RequestSink* sink) { return sink->wants(level, sm); });
    }

    void issued(std::span<const IssuedAccess> accesses) const {
        for (RequestSink* const sink : sinks_) sink->issued(accesses);
    }
    /// `sm`: as RequestSink::wants() has it.
    void served(std::size_t level, std::uint32_t sm, std::span<const ServedRequest> requests) const {
        for (RequestSink* const sink : sinks_)
            if (sink->wants(level, sm)) sink->served(level, requests);
    }
    void end_window() const {
        for (RequestSink* const sink : sinks_) sink->end_window();
    }

private:
    std::vector<RequestSink*> sinks_;
    bool any_ = false;
};

}  // namespace raycache::cachesim
