#include "cachesim/gpus/toml_guard.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "traces/printable.hpp"

namespace raycache::cachesim {
namespace {

constexpr int most_nested = 16;     ///< of lists and tables within each other
constexpr int most_key_parts = 16;  ///< of a dotted key: each is a level too

bool is_digit_or_letter(char c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
bool is_bare(char c) { return is_digit_or_letter(c) || c == '_' || c == '-'; }
bool is_scalar(char c) { return is_bare(c) || c == '+' || c == '.'; }

/// Goes through the text once; throws TomlProblem.
class Walk {
public:
    explicit Walk(std::string_view text) : rest_(text) {}

    void run() {
        if (rest_.starts_with("\xEF\xBB\xBF")) take(3);  // byte order mark
        while (!rest_.empty()) {
            blanks();
            if (next('['))
                header();
            else if (!rest_.empty() && !next('#') && !at_line_end())
                pair();
            blanks();
            comment();
            if (!rest_.empty()) line_end("the end of the line");
        }
    }

private:
    [[noreturn]] void fail(const std::string& expected) const {
        const auto byte = rest_.empty() ? 0U : static_cast<unsigned>(static_cast<unsigned char>(rest_.front()));
        const std::string found = rest_.empty()                ? "the end of the file"
                                  : at_line_end()              ? "the end of the line"
                                  : byte < 0x20 || byte > 0x7e ? fmt::format("the byte {:#04x}", byte)
                                                               : fmt::format("'{}'", rest_.front());
        throw TomlProblem{line_, fmt::format("expected {}, found {}", expected, found)};
    }

    bool next(char c) const { return !rest_.empty() && rest_.front() == c; }
    bool at_line_end() const { return next('\n') || rest_.starts_with("\r\n"); }
    void take(std::size_t bytes) { rest_.remove_prefix(bytes); }
    void expect(char c, const char* what) {
        if (!next(c)) fail(what);
        take(1);
    }
    void blanks() { take(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }
    void line_end(const char* expected) {
        if (!at_line_end()) fail(expected);
        take(next('\r') ? 2 : 1);
        ++line_;
    }
    void comment() {
        if (!next('#')) return;
        while (!rest_.empty() && !at_line_end()) character();
    }
    /// Blanks, comments and line ends, where a list may go on in another line.
    void gap() {
        for (blanks(); at_line_end() || next('#'); blanks()) {
            comment();
            if (!rest_.empty()) line_end("the end of the line");
        }
    }

    /// One character of a string or comment: no control character but the tab, and whole UTF-8.
    void character() {
        const auto byte = static_cast<unsigned char>(rest_.front());
        if ((byte < 0x20 && byte != '\t') || byte == 0x7f) fail("no control character");
        const std::size_t bytes = utf8_bytes(rest_);
        if (bytes == 0) fail("UTF-8 text");
        take(bytes);
    }

    void string() {
        const char quote = rest_.front();
        const std::string fence(3, quote);
        const bool lines = rest_.starts_with(fence);
        take(lines ? 3 : 1);
        for (;;) {
            if (rest_.empty()) fail(lines ? "the three quotes that end the text" : "the quote that ends the text");
            if (lines && rest_.starts_with(fence)) {
                // Up to two quotes may stand before the three that end it.
                take(std::min<std::size_t>(std::min(rest_.find_first_not_of(quote), rest_.size()), 5));
                return;
            }
            if (!lines && next(quote)) return take(1);
            if (at_line_end()) {
                if (!lines) fail("the quote that ends the text");
                line_end("");
                continue;
            }
            const bool escape = quote == '"' && next('\\');
            character();
            if (escape && !rest_.empty() && !at_line_end()) character();
        }
    }

    void key() {
        for (int parts = 1;; ++parts) {
            if (parts > most_key_parts) fail(fmt::format("a key of at most {} parts", most_key_parts));
            blanks();
            if ((next('"') || next('\'')) && !rest_.starts_with("\"\"\"") && !rest_.starts_with("'''"))
                string();
            else if (rest_.empty() || !is_bare(rest_.front()))
                fail("a key of letters A to Z, digits, '_' and '-', or one in quotes");
            else
                take(std::min(
                    static_cast<std::size_t>(std::find_if_not(rest_.begin(), rest_.end(), is_bare) - rest_.begin()),
                    rest_.size()));
            blanks();
            if (!next('.')) return;
            take(1);
        }
    }

    void header() {
        const bool list = rest_.starts_with("[[");
        take(list ? 2 : 1);
        key();
        expect(']', "']' behind the name of the table");
        if (list) expect(']', "']]' behind the name of the table");
    }

    void pair() {
        key();
        expect('=', "'=' behind the key");
        blanks();
        value();
    }

    void value() {
        if (next('"') || next('\'')) return string();
        if (next('[') || next('{')) {
            if (++levels_ > most_nested) fail(fmt::format("at most {} levels", most_nested));
            next('[') ? list() : table();
            --levels_;
            return;
        }
        if (rest_.empty() || !is_scalar(rest_.front())) fail("a number, text, list or table");
        take(static_cast<std::size_t>(std::find_if_not(rest_.begin(), rest_.end(), is_scalar) - rest_.begin()));
    }

    void list() {
        take(1);
        for (gap(); !next(']'); gap()) {
            value();
            gap();
            if (!next(',')) break;
            take(1);
        }
        expect(']', "',' or ']' behind an entry of the list");
    }

    void table() {
        take(1);
        blanks();
        if (!next('}')) pair();
        for (blanks(); next(','); blanks()) {
            take(1);
            pair();
        }
        expect('}', "',' or '}' behind a value of the table");
    }

    std::string_view rest_;
    std::size_t line_ = 1;
    int levels_ = 0;
};

}  // namespace

std::optional<TomlProblem> find_toml_problem(std::string_view text) {
    try {
        Walk(text).run();
    } catch (const TomlProblem& problem) {
        return problem;
    }
    return std::nullopt;
}

}  // namespace raycache::cachesim
