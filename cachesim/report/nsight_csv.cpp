#include "cachesim/report/nsight_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::cachesim {

namespace {

constexpr const char* how_to_make = "'ncu --csv --page raw' prints such a table, with --import of a report, too";

struct CsvRecord {
    std::size_t line = 0;  ///< where it begins
    std::vector<std::string> fields;
};

/// Record after record of the text.
class CsvReader {
public:
    CsvReader(std::string_view text, const std::string& file) : text_(text), file_(file) {
        constexpr std::string_view mark = "\xef\xbb\xbf";
        if (text_.starts_with(mark)) at_ = mark.size();
    }

    /// False at the end. Leaves out empty lines and messages.
    bool next(CsvRecord& record) {
        for (;;) {
            while (at_ < text_.size() && (text_[at_] == '\n' || text_[at_] == '\r')) {
                line_ += text_[at_] == '\n';
                ++at_;
            }
            if (at_ == text_.size()) return false;
            if (!text_.substr(at_).starts_with("==")) break;
            skip_line();
        }
        record.line = line_;
        record.fields.clear();
        do {
            record.fields.push_back(field());
        } while (at_ < text_.size() && text_[at_++] == ',');
        if (at_ > 0 && at_ <= text_.size() && text_[at_ - 1] == '\n') ++line_;
        return true;
    }

    /// What the program that was profiled printed, up to the titles: their first field is the first word of a line.
    bool skip_to_titles() {
        while (at_ < text_.size()) {
            const std::string_view rest = text_.substr(at_);
            if (rest.starts_with("\"ID\",") || rest.starts_with("ID,")) return true;
            skip_line();
        }
        return false;
    }

private:
    void skip_line() {
        const std::size_t end = text_.find('\n', at_);
        at_ = end == std::string_view::npos ? text_.size() : end + 1;
        ++line_;
    }

    std::string field() {
        std::string value;
        if (at_ < text_.size() && text_[at_] == '"') {
            const std::size_t line = line_;
            for (++at_;; ++at_) {
                if (at_ == text_.size())
                    throw Error(
                        fmt::format("{}: line {}: a quote is not closed; the file may be cut off", file_, line));
                if (text_[at_] == '"') {
                    ++at_;
                    if (at_ == text_.size() || text_[at_] != '"') break;
                }
                line_ += text_[at_] == '\n';
                value += text_[at_];
            }
        }
        while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n') value += text_[at_++];
        if (value.ends_with('\r')) value.pop_back();
        return value;
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0, line_ = 1;
};

constexpr std::size_t no_column = ~std::size_t{0};

std::size_t column_of(const CsvRecord& titles, std::string_view title) {
    const auto at = std::find(titles.fields.begin(), titles.fields.end(), title);
    return at == titles.fields.end() ? no_column : static_cast<std::size_t>(at - titles.fields.begin());
}

/// The launches of a profile, found by what a line says of its own.
class LaunchTable {
public:
    explicit LaunchTable(const CsvRecord& titles)
        : process_(column_of(titles, "Process ID")), kernel_(column_of(titles, "Kernel Name")) {}

    MeasuredLaunch& launch_of(const CsvRecord& record) {
        const std::string &id = record.fields[0],
                          of_process = process_ == no_column ? std::string() : record.fields[process_];
        const auto [at, is_new] = places_.try_emplace({of_process, id}, launches_.size());
        if (is_new)
            launches_.push_back({id, of_process, kernel_ == no_column ? std::string() : record.fields[kernel_], {}});
        return launches_[at->second];
    }
    std::vector<MeasuredLaunch>& launches() { return launches_; }

private:
    std::size_t process_, kernel_;
    std::map<std::pair<std::string, std::string>, std::size_t> places_;  ///< by process and number in it
    std::vector<MeasuredLaunch> launches_;
};

/// "1,234.5" without commas; none where these do not part thousands.
std::optional<std::string> without_thousands(std::string_view text) {
    std::string plain;
    const std::size_t end = std::min(text.find('.'), text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != ',') {
            plain += text[i];
            continue;
        }
        if (i == 0 || i > end || (end - i) % 4 != 0) return std::nullopt;
    }
    return plain;
}

struct Scaled {
    char prefix;
    int exponent;  ///< of 10
};
constexpr std::array prefixes{Scaled{'K', 3},  Scaled{'M', 6},  Scaled{'G', 9}, Scaled{'T', 12},
                              Scaled{'m', -3}, Scaled{'u', -6}, Scaled{'n', -9}};
constexpr std::array<std::string_view, 8> nouns{"byte", "sector", "request", "inst", "thread", "cycle", "second", "s"};

/// Of the plain unit one of this is 10 to the power of the result; none for what is not known.
std::optional<int> exponent_of_noun(std::string_view noun) {
    const auto known = [](std::string_view n) { return std::find(nouns.begin(), nouns.end(), n) != nouns.end(); };
    if (known(noun)) return 0;
    for (const Scaled& scaled : prefixes)
        if (noun.starts_with(scaled.prefix) && known(noun.substr(1))) return scaled.exponent;
    return std::nullopt;
}

std::string_view plain_noun(std::string_view noun) {
    const auto is = [&](std::string_view n) { return noun == n || (noun.size() == n.size() + 1 && noun.ends_with(n)); };
    if (is("s") || is("second")) return "second";
    for (const std::string_view n : nouns)
        if (is(n)) return n;
    return noun;
}

struct Parts {
    std::string_view above, below;
};
Parts parts_of(std::string_view unit) {
    const std::size_t at = unit.find('/');
    return at == std::string_view::npos ? Parts{unit, {}} : Parts{unit.substr(0, at), unit.substr(at + 1)};
}

/// Of `wanted` one of `unit` is 10 to the power of the result.
std::optional<int> exponent_of(std::string_view unit, std::string_view wanted) {
    const Parts from = parts_of(unit), to = parts_of(wanted);
    int exponent = 0;
    for (const auto& [a, b, above] :
         {std::tuple{from.above, to.above, true}, std::tuple{from.below, to.below, false}}) {
        if (a.empty() && b.empty()) continue;
        const auto x = exponent_of_noun(a), y = exponent_of_noun(b);
        if (!x || !y || plain_noun(a) != plain_noun(b)) return std::nullopt;
        exponent += above ? *x - *y : *y - *x;
    }
    return exponent;
}

}  // namespace

NsightProfile read_nsight_csv(std::string_view text, const std::string& file) {
    if (text.empty()) throw Error(fmt::format("{}: the file is empty; {}", file, how_to_make));
    if (text.find('\0') != std::string_view::npos)
        throw Error(fmt::format("{}: expected a table in CSV, found binary data; {}", file, how_to_make));
    CsvReader reader(text, file);
    CsvRecord titles, record;
    if (!reader.skip_to_titles() || !reader.next(titles))
        throw Error(
            fmt::format("{}: expected a line of titles that begins with \"ID\", found none: no table of Nsight "
                        "Compute; {}",
                        file, how_to_make));
    LaunchTable table(titles);
    const std::size_t name = column_of(titles, "Metric Name"), unit = column_of(titles, "Metric Unit"),
                      value = column_of(titles, "Metric Value");
    if (name != no_column && value == no_column)
        throw Error(
            fmt::format("{}: line {}: expected a column \"Metric Value\", found none: a summary of several "
                        "launches, as --print-summary makes; {}",
                        file, titles.line, how_to_make));
    CsvRecord units;
    while (reader.next(record)) {
        if (record.fields == titles.fields) continue;  // of another process
        if (record.fields.size() != titles.fields.size())
            throw Error(fmt::format("{}: line {}: expected {} fields, as the titles have, found {}", file, record.line,
                                    titles.fields.size(), record.fields.size()));
        if (name != no_column) {
            if (record.fields[name].empty()) continue;  // a rule's
            table.launch_of(record).metrics.push_back(
                {record.fields[name], unit == no_column ? "" : record.fields[unit], record.fields[value], record.line});
            continue;
        }
        if (record.fields[0].empty()) {
            units = record;
            continue;
        }
        MeasuredLaunch& launch = table.launch_of(record);
        for (std::size_t i = 1; i < record.fields.size(); ++i)
            if (titles.fields[i].find("__") != std::string::npos)
                launch.metrics.push_back(
                    {titles.fields[i], units.fields.empty() ? "" : units.fields[i], record.fields[i], record.line});
    }
    if (table.launches().empty())
        throw Error(
            fmt::format("{}: no launch below the titles: the profiler met no kernel, or could not read its "
                        "counters (see its messages)",
                        file));
    return {file, std::move(table.launches())};
}

double measured_value(const MeasuredMetric& metric, std::string_view unit, const std::string& file) {
    const std::string& text = metric.value;
    if (text.empty() || text.find("n/a") != std::string::npos || text == "nan") return std::nan("");
    const std::optional<std::string> plain = without_thousands(text);
    double number = 0;
    if (plain) {
        const auto [end, error] = std::from_chars(plain->data(), plain->data() + plain->size(), number);
        if (error != std::errc() || end != plain->data() + plain->size() || !std::isfinite(number)) number = -1;
    }
    if (!plain || number < 0)
        throw Error(fmt::format("{}: line {}: {}: expected a number such as 1234.5 or 1,234.5, found '{}'", file,
                                metric.line, printable_line(metric.name), printable_line(text)));
    if (metric.unit.empty() || metric.unit == unit || unit == "%") return number;
    const std::optional<int> exponent = exponent_of(metric.unit, unit);
    if (!exponent)
        throw Error(
            fmt::format("{}: line {}: {}: expected its unit to be {}, or that with K, M, G before it, found '{}'; "
                        "--print-units base prints it so",
                        file, metric.line, printable_line(metric.name), unit, printable_line(metric.unit)));
    const double power = std::pow(10, std::abs(*exponent));  // exact: so is a whole number of it
    return *exponent < 0 ? number / power : number * power;
}

}  // namespace raycache::cachesim
