// The tables of docs/sampling.md about all sequences and strategies: `raycache samples --table NAME`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace raycache::tools {

/// Rows of text; the first column is the name.
struct SamplesTable {
    std::string title, note;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// Names of the tables.
const std::vector<std::string>& samples_tables();

/// Throws UsageError for an unknown name (listing the valid ones) or sequence. Where a strategy is not defined for the
/// sequence or N, its cells are "-".
std::vector<SamplesTable> make_samples_tables(const std::string& name, const std::string& sequence, std::uint64_t seed);

std::string to_text(const std::vector<SamplesTable>&);
std::string to_json(const std::vector<SamplesTable>&);

}  // namespace raycache::tools
