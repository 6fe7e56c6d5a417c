// What a job says while it works: how far it is, what it warns of, what an interrupted one can be resumed from.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace raycache::tools {

/// Kinds of work. What one stage of a kind takes says what another of that kind will take.
enum class Work { prepare, render, trace, replay, timed_replay };

/// Where a line for the user goes, such as a warning: no line break, no "warning:" before it.
using Say = std::function<void(const std::string&)>;

/// Who listens to a job. Every function does nothing unless it is overridden: Observer itself is a listener that keeps
/// silent. The job calls them from the thread that runs it, advance() also from others.
class Observer {
public:
    Observer() = default;
    Observer(const Observer&) = delete;
    Observer& operator=(const Observer&) = delete;
    virtual ~Observer() = default;

    /// A stage is to come, or will take another time than was said before: `seconds`, by costs.hpp.
    virtual void expect(const std::string& /*stage*/, Work, double /*seconds*/) {}
    /// That stage runs from now on; one at a time. `total` in units of work, 0 where none is counted; `unit` names what
    /// the rate counts, such as "rays".
    virtual void begin(const std::string& /*stage*/, std::uint64_t /*total*/, const std::string& /*unit*/) {}
    /// Progress within the stage: work done since the last call, and the units of it that the rate counts.
    virtual void advance(std::uint64_t /*work*/, std::uint64_t /*units*/) {}
    /// The stage is over.
    virtual void end() {}

    virtual void warn(const std::string& /*line*/) {}
    /// What the user can go on from if the job ends before its time, from now on: "the reference FILE is kept: …".
    virtual void resumable(const std::string& /*advice*/) {}

    /// warn() as a function, for as long as this object lives.
    Say warning() {
        return [this](const std::string& line) { warn(line); };
    }
};

/// A stage while it runs.
class Stage {
public:
    explicit Stage(Observer& observer, const std::string& name, std::uint64_t total = 0, const std::string& unit = {})
        : observer_(observer) {
        observer_.begin(name, total, unit);
    }
    ~Stage() { observer_.end(); }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    /// Thread-safe: see Observer::advance().
    void add(std::uint64_t work, std::uint64_t units) const { observer_.advance(work, units); }

private:
    Observer& observer_;
};

}  // namespace raycache::tools
