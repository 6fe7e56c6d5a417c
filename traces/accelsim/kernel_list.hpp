// Which files hold the kernels of a trace: the file itself, what a kernelslist.g names, or that of a folder.
#pragma once

#include <string>
#include <vector>

namespace raycache::traces {

/// A folder, or a text whose lines are names of files and copies of memory ("MemcpyHtoD,0x…,BYTES").
bool looks_like_kernel_list(const std::string& path);

/// The kernels' files, in order of launch; their names are relative to the list. Throws Error if one is missing, the
/// list names none, or the folder has no kernelslist.g.
std::vector<std::string> read_kernel_list(const std::string& path);

}  // namespace raycache::traces
