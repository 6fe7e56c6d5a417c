// --json, and what every JSON document of the program begins with: which program said it, what it was asked, of which
// GPUs and traces. docs/json.md describes the documents for readers.
#pragma once

#include <string>

#include "tools/jobs/subject.hpp"

namespace raycache::tools {

class Command;

/// Raised when a key of any document is renamed, removed, or changes its meaning; new keys leave it as it is.
inline constexpr int json_schema_version = 1;

/// The flag --json of a command.
class JsonOption {
public:
    void add(Command&);
    explicit operator bool() const { return asked_; }
    /// `report`, a JSON object, behind the envelope: schema_version, program, version, command, command_line, settings,
    /// and gpus and traces where the subject has any. Independent of --threads and of where results are written.
    /// A key of the report must not be one of the envelope's.
    std::string document(const std::string& report, const Subject& = {}) const;

private:
    const Command* command_ = nullptr;
    bool asked_ = false;
};

}  // namespace raycache::tools
