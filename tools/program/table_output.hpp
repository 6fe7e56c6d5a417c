// --json, --wide and --csv of a command that prints one report, and the report in the form that was asked for.
#pragma once

#include <string>

#include "tools/program/console.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/width_option.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

struct TableOutput {
    JsonOption json;
    WidthOption width;
    bool csv = false;

    void add(Command& command, const std::string& csv_help = "print CSV") {
        json.add(command);
        width.add(command);
        command.add_flag("--csv", csv, csv_help)->excludes({"--json"});
    }
    /// Throws UsageError for two forms at once.
    void check() const {
        if (json && csv) throw UsageError("--json and --csv together; expected one of them");
    }
    /// By the report's to_json(), to_csv() and to_text(report, width).
    template <class Report>
    void publish(const Report& report, const Subject& subject) const {
        print(json ? json.document(to_json(report), subject) : csv ? to_csv(report) : to_text(report, width.columns()));
    }
};

}  // namespace raycache::tools
