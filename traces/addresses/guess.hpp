// What a file to be imported looks like.
#pragma once

#include <string>

namespace raycache::traces {

enum class TraceKind { accel_sim, rtwarp, dinero, csv, u64 };

/// By the content (of u64 by the name, "….u64"). Throws Error that names what the file looks like, and what can be
/// read, if it is none of them: a trace of this project, of Lackey, of NVBit's mem_trace, of libCacheSim
/// (oracleGeneral), a list of the tracer before post-processing, text or bytes of another kind.
TraceKind guess_trace_kind(const std::string& path);

}  // namespace raycache::traces
