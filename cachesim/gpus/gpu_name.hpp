// How a GPU's name may be written.
#pragma once

#include <string>

namespace raycache::cachesim {

/// A preset's name as load_gpu() takes it, from one in other letters: "RTX_3070" and "rtx3070" are "rtx-3070". The path
/// of a file stays as it is. Throws UsageError for any other, with the closest name.
std::string find_gpu_name(const std::string&);

}  // namespace raycache::cachesim
