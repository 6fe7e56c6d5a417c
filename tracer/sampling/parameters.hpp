// Settings by name, as a user types them. What they mean, who needs them says: a decorrelation, or an integrator, states
// its parameters in its own file, and reads them from here.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace raycache::tracer {

/// One setting that something may be given.
struct ParameterEntry {
    const char* name;         ///< "k", "cycles-min-samples"
    const char* description;  ///< one line
    const char* fallback;     ///< what it is where it is not given; empty: absent
    const char* label;        ///< in messages: "K"
    const char* remedy;       ///< in messages: "give K such as 2.5"
    bool whole = false;       ///< a whole number
    double least = 0;
    double most = std::numeric_limits<double>::infinity();  ///< infinity: no limit, though finite
    const char* word = "";                                  ///< that may stand instead of a number: "discrepancy"
    /// Of what is no number but words: throws UsageError for what it may not be. Null: a number.
    void (*check)(const std::string&) = nullptr;
    /// Of what is one of a few words, up to the first null: these.
    std::array<const char*, 4> choices{};
    const char* topic = "sampling";  ///< in messages: what it belongs to

    bool has_choices() const { return choices[0] != nullptr; }
    std::vector<std::string> choice_names() const;
};

/// What was given.
class Parameters {
public:
    void set(const std::string& name, std::string value) { given_[name] = std::move(value); }
    void set(const std::string& name, const char* value) { given_[name] = value; }
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void set(const std::string& name, Number value) {
        if constexpr (std::is_integral_v<Number>)
            given_[name] = std::to_string(value);
        else
            set_real(name, value);
    }
    void unset(const std::string& name) { given_.erase(name); }

    bool has(const std::string& name) const { return given_.contains(name); }
    /// As given; empty if not given.
    std::string text(const std::string& name) const;
    /// The same as a number; nothing if not given or none.
    std::optional<double> number(const std::string& name) const;
    const std::map<std::string, std::string>& given() const { return given_; }

    // What was given, or the entry's fallback. Throw UsageError for what the entry does not allow.
    double real(const ParameterEntry&) const;
    std::uint64_t whole(const ParameterEntry&) const;
    bool is_word(const ParameterEntry&) const;
    std::string word(const ParameterEntry&) const;  ///< of an entry with a check or choices

    bool operator==(const Parameters&) const = default;

private:
    void set_real(const std::string& name, double value);
    std::string text(const ParameterEntry&) const;

    std::map<std::string, std::string> given_;
};

/// Throws UsageError for a value that the entry does not allow: "sampling: K must be …, found …: give …".
void check_parameter(const ParameterEntry&, const std::string& value);

}  // namespace raycache::tracer
