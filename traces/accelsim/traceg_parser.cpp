#include "traces/accelsim/traceg_parser.hpp"

#include <fmt/format.h>

#include "traces/accelsim/text_lines.hpp"
#include "traces/accelsim/traceg_reader.hpp"
#include "traces/accelsim/tracez_file.hpp"

namespace raycache::traces {
namespace {

class Parser {
public:
    Parser(const std::string& path, const TracegReader::Use& use, const TracegOptions& options)
        : lines_(path), reader_(use, options) {}

    TracegKernel run() {
        while (next_full_line() && line_[0] == '-') reader_.header_line(line_, lines_);
        if (line_.empty() || line_[0] != '#')
            lines_.refuse("header", "lines that begin with '-', then '#traces format'", line_);
        reader_.end_header(lines_);
        while (next_full_line()) {
            if (line_.starts_with("#BEGIN_TB"))
                read_block();
            else if (line_[0] != '#')
                refuse_outside();
        }
        return reader_.finish(lines_);
    }

private:
    /// The next line that is not empty.
    bool next_full_line() {
        while (lines_.next(line_))
            if (line_.find_first_not_of(" \t") != std::string_view::npos) return true;
        return false;
    }

    [[noreturn]] void refuse_outside() const {
        if (count_numbers_before(line_) >= 4)
            lines_.refuse("between thread blocks", "#BEGIN_TB", "an instruction: a trace before post-processing",
                          "run post-traces-processing on its kernelslist, and import what that writes");
        lines_.refuse("between thread blocks", "#BEGIN_TB", line_);
    }

    void read_block() {
        reader_.begin_block(lines_);
        bool in_warp = false;
        while (next_full_line()) {
            if (line_.starts_with("#END_TB")) {
                reader_.end_block();
                return;
            }
            if (line_[0] == '#' || line_.starts_with("cluster ")) continue;
            if (const auto at = TracegReader::value_of(line_, "thread block")) {
                reader_.coordinates(TracegReader::triple("thread block", *at, lines_), lines_);
            } else if (const auto text = TracegReader::value_of(line_, "warp")) {
                reader_.begin_warp(TracegReader::number("warp", *text, lines_), lines_);
                in_warp = true;
            } else if (const auto count = TracegReader::value_of(line_, "insts")) {
                if (!in_warp) lines_.refuse("thread block", "warp = N before its instructions", line_);
                read_warp(TracegReader::number("insts", *count, lines_));
                in_warp = false;
            } else {
                lines_.refuse("thread block", "warp, insts or #END_TB", line_);
            }
        }
        lines_.refuse("end of the file", "#END_TB", "a thread block without an end");
    }

    void read_warp(std::uint64_t instructions) {
        for (std::uint64_t i = 0; i < instructions; ++i) {
            if (!next_full_line() || line_[0] == '#' || TracegReader::value_of(line_, "warp"))
                lines_.refuse("warp", fmt::format("{} instructions", instructions), fmt::format("{}", i));
            reader_.instruction(line_, lines_);
        }
    }

    TextLines lines_;
    TracegReader reader_;
    std::string_view line_;
};

}  // namespace

TracegKernel parse_traceg(const std::string& path, const std::function<void(std::uint64_t, GlobalLoad&)>& load,
                          const TracegOptions& options) {
    if (looks_like_tracez(path)) return parse_tracez(path, load, options);
    return Parser(path, load, options).run();
}

}  // namespace raycache::traces
