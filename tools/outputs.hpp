// Files that a command is about to write: never over what it reads.
#pragma once

#include <string>
#include <vector>

namespace raycache::tools {

using FileNames = std::vector<std::string>;

/// Throws UsageError if an output, or what is written until it is whole, is the file of an input, under whatever name
/// or link. Empty names and files that do not exist are passed over.
void refuse_overwriting(const FileNames& inputs, const FileNames& outputs);

/// Throws UsageError if `path` is "-", where stdout is for something else.
void refuse_stdout(const char* option, const std::string& path);

}  // namespace raycache::tools
