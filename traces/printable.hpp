// Text of unknown origin, made fit for a terminal: names in traces, scenes and GPU files may hold escape sequences,
// line breaks, or characters that turn the direction of what follows.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace raycache {

/// On one line: every tab and line break becomes a space, every other control character, invisible formatting character
/// (direction marks such as U+202E, zero-width ones, line separators) and byte that is no UTF-8 a question mark.
std::string printable_line(std::string_view text);

/// The same, but line feeds stay: for whole reports.
std::string printable_text(std::string_view text);

/// Of JSON text in UTF-8: what printable_text() would replace stands as its \u escape, so the values stay what they
/// are.
std::string printable_json(std::string_view text);

/// Of the character at the start of a text that is not empty; 0 where there is no whole UTF-8 character (RFC 3629).
std::size_t utf8_bytes(std::string_view text);

}  // namespace raycache
