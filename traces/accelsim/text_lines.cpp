#include "traces/accelsim/text_lines.hpp"

#include <fmt/format.h>

#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::traces {

namespace {

/// One line of a message, whatever was in the file.
std::string excerpt(std::string_view text) {
    return printable_line(text.substr(0, 60)) + (text.size() > 60 ? "…" : "");
}

}  // namespace

void TextPlace::refuse(std::string_view what, std::string_view expected, std::string_view found,
                       std::string_view remedy) const {
    throw Error(fmt::format("{}: {}: expected {}, found {}; {}", where(), what, expected, excerpt(found), remedy));
}

bool TextLines::next(std::string_view& line) {
    std::size_t end = text_.find('\n', at_), searched = text_.size();
    while (end == std::string::npos) {
        text_.erase(0, at_);
        searched -= at_;
        at_ = 0;
        if (text_.size() > most_line_bytes) {
            ++line_;
            refuse("line", "at most a million characters", "more");
        }
        if (!source_.read(text_)) {
            if (text_.empty()) {
                line = {};
                return false;
            }
            text_ += '\n';  // a last line without an end
        }
        end = text_.find('\n', searched);
        searched = text_.size();
    }
    line = std::string_view(text_).substr(at_, end - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = end + 1;
    ++line_;
    return true;
}

std::string TextLines::where() const { return fmt::format("{}: line {}", path_, line_); }

}  // namespace raycache::traces
