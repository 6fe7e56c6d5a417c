// The tables of docs/sampling.md: figures about samples alone, measured without a scene.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace raycache::tools {

struct SamplesTable {
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::variant<std::string, double>>> rows;  ///< as many cells as columns; NaN: none

    std::string text() const;
    std::string json() const;
};

/// "holes", "bias", …
std::vector<std::string> samples_table_names();

/// Throws UsageError for an unknown name. Takes up to half a minute.
SamplesTable make_samples_table(const std::string& name);

}  // namespace raycache::tools
