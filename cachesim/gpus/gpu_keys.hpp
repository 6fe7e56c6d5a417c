// The keys of GPU files, described: what a user may write, and what `--set` takes.
#pragma once

#include <string>
#include <vector>

namespace raycache::cachesim {

struct GpuKey {
    std::string section;        ///< "" for the chip, "timing", "rt_unit", …; "l1" stands for l2 and l3, too
    std::string name;           ///< "ways"
    bool needed = false;        ///< must be there if its section is
    std::string default_value;  ///< what holds without it: "32", "from `[registers]`"; empty if needed
    std::string values;         ///< "1 to 4096", "`modulo`, `xor_fold`"
    std::string unit;           ///< "cycles"; empty: a count of what the name says, or no number
    std::string meaning;
};

/// Every key, in the order of the sections and within them of reading.
std::vector<GpuKey> gpu_keys();

/// Every key as `--set` takes it, "sms", "l1.ways", "l2.ways"; name and description left out.
std::vector<std::string> gpu_key_names();

/// Whether a key as `--set` takes it is one that counts bytes.
bool counts_bytes(const std::string& key_name);

}  // namespace raycache::cachesim
