// What the arguments of compare and explain are: one scene, or traces. The content of a file tells, not its name.
#pragma once

#include <string>
#include <vector>

#include "tools/program/command.hpp"

namespace raycache::tools {

enum class InputKind { scene, trace, unknown };

/// By the first bytes of a file: a trace, glTF (binary or text), or neither. A built-in scene's name is a scene. What
/// cannot be read, such as a file that does not exist yet, is taken for what its name ends in: .glb and .gltf for a
/// scene, .rct for a trace.
InputKind kind_of_input(const std::string& name);

struct Inputs {
    std::string scene;  ///< empty: traces
    std::vector<std::string> traces;
};

/// The arguments INPUTS and --scene, told apart.
class InputOptions {
public:
    /// `traces`: how the help text calls them, such as "two trace files, BASE and OTHER".
    void add(Command&, const std::string& traces);

    /// Throws UsageError for no input and for a scene beside another input.
    Inputs sorted(const Command& command) const;

private:
    std::vector<std::string> names_;
    std::string scene_, traces_;
};

}  // namespace raycache::tools
