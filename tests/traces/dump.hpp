// A trace as text, every record of it. traces/read_trace.py --dump prints the same.
#pragma once

#include <string>

std::string dump_trace(const std::string& path);
