// A figure of a report: a quotient of counts with its name, unit, meaning and the way it is shown. Every table, file
// and page of a report follows from lists of these: traffic_figures.hpp, timed_figures.hpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "cachesim/analysis/counts.hpp"

namespace raycache::cachesim {

/// What the number is. Totals are over all sample indices of a row.
enum class Of {
    total,     ///< a whole number
    quotient,  ///< of totals
    mean,      ///< a quotient of totals with its interval over sample indices
    ratio,     ///< the mean over that of the baseline, paired by sample index
    gain,      ///< the baseline's over it, likewise
};

enum class Better { neither, lower, higher };

/// Where a report shows a figure beside those that it always shows.
enum class Presence {
    always,
    three_levels,  ///< some GPU has an L3
    rt_unit,       ///< some GPU has its RT units walk the BVH
    wavefront,     ///< some trace is of a wavefront
};

/// The tables of a timed report.
enum class Table { none, main, hits, use, rates };

/// Fields of files in JSON and CSV.
enum class Field { in_both, json, csv, neither };

/// As many decimals as make about four digits.
inline constexpr int about_four_digits = -1;

template <class Quantity>
struct Figure {
    const char* key;  ///< in CSV, JSON and the source: "steps_per_ray"
    Of of = Of::mean;
    const char* title;       ///< "steps per ray"; a page breaks it at the first space
    const char* unit;        ///< "share": of 1, shown in percent
    const char* definition;  ///< in one sentence
    Quantity numerator;
    std::optional<Quantity> denominator{};  ///< none: 1 for each sample index
    std::optional<Quantity> per{};          ///< a constant of the GPU that a quotient is divided by, too

    // In tables for a terminal.
    const char* column = nullptr;    ///< title; null: no column
    double scale = 1;                ///< 100 where the column is in percent
    int digits = about_four_digits;  ///< decimals
    bool interval = false;           ///< with ±
    unsigned rank = 0;               ///< of TextTable
    Table table = Table::main;
    const char *subject = nullptr, *legend = nullptr;  ///< "B/ray" and what is said of it below the table

    Better better = Better::neither;
    const char* profiler = nullptr;  ///< the metric of Nsight Compute that counts the same, of loads

    // On a page in HTML.
    bool page = false;
    int page_digits = digits;

    // In files.
    const char* object = nullptr;  ///< of JSON that holds it; null: the row itself
    const char* name = key;        ///< in that object
    Field field = Field::in_both;
    unsigned part = 0;  ///< of the fields of CSV, which come part by part
    Presence presence = Presence::always;

    bool of_cold_launch = false;  ///< says nothing of the steady state: absent in estimates from windows
    bool of_factors = false;      ///< of the traffic identity: there where all its factors have a value
    /// Of a timed report: absent where no time is predicted.
    bool in_time = false;
    double of_nothing = std::numeric_limits<double>::quiet_NaN();  ///< the quotient where the denominator is 0

    constexpr bool in_json() const { return field == Field::in_both || field == Field::json; }
    constexpr bool in_csv() const { return field == Field::in_both || field == Field::csv; }

    /// In files.
    constexpr bool has_interval() const { return of == Of::mean || is_compared(); }
    constexpr bool is_compared() const { return of == Of::ratio || of == Of::gain; }

    /// Of::total.
    template <class Statistics>
    std::uint64_t total(const Statistics& totals, const CacheUnits& units) const {
        return static_cast<std::uint64_t>(numerator(totals, units));
    }
    /// The quotient of totals.
    template <class Statistics>
    double value(const Statistics& totals, const CacheUnits& units) const {
        const auto y = static_cast<double>(numerator(totals, units));
        if (!denominator) return y;
        const auto x = static_cast<double>((*denominator)(totals, units));
        const double divisor = per ? static_cast<double>((*per)(totals, units)) : 1;
        return x == 0 || divisor == 0 ? of_nothing : y / x / divisor;
    }
};

/// The place of a figure in a list, found when the program is compiled: a key that is in none does not compile.
template <const auto& list>
struct FigureIn {
    consteval FigureIn(const char* key) : index(place_of(key)) {}
    std::size_t index;

private:
    static consteval std::size_t place_of(std::string_view key) {
        for (std::size_t i = 0; i < std::size(list); ++i)
            if (list[i].key == key) return i;
        throw "no figure of the list has this key";
    }
};

}  // namespace raycache::cachesim
