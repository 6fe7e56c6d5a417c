// --json, and what every JSON document of the program begins with: which program said it, what it was asked, of which
// GPUs and traces. docs/json.md describes the documents for readers.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "traces/header.hpp"

namespace raycache::tools {

class Command;

/// Raised when a key of any document is renamed, removed, or changes its meaning; new keys leave it as it is.
inline constexpr int json_schema_version = 1;

/// What a report is about, beyond the options: the values that stand behind them.
struct JsonSubject {
    std::vector<cachesim::Gpu> gpus;
    std::vector<nlohmann::ordered_json> traces;  ///< settings_json() of each trace or capture
};

/// The flag --json of a command.
class JsonOption {
public:
    void add(Command&);
    explicit operator bool() const { return asked_; }
    /// `report`, a JSON object, behind the envelope: schema_version, program, version, command, command_line, settings,
    /// and gpus and traces where the subject has any. Independent of --threads and of where results are written.
    /// A key of the report must not be one of the envelope's.
    std::string document(const std::string& report, const JsonSubject& = {}) const;

private:
    const Command* command_ = nullptr;
    bool asked_ = false;
};

/// What a trace says of its making: scene, camera, strategy, N, seed, picture, paths, execution, sample indices.
/// `file`: its name, empty for a capture that was never in a file.
nlohmann::ordered_json settings_json(const traces::Header&, const std::string& file);

/// As UTF-8 with an indent of 2 and a line break at the end; a name that is no UTF-8 shows U+FFFD.
std::string json_text(const nlohmann::ordered_json&);

}  // namespace raycache::tools
