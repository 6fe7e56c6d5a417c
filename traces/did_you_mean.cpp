#include "traces/did_you_mean.hpp"

#include <algorithm>
#include <numeric>

namespace raycache {
namespace {

std::string folded(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c >= 'A' && c <= 'Z')
            out += static_cast<char>(c - 'A' + 'a');
        else
            out += c == '_' || c == ' ' ? '-' : c;
    }
    return out;
}

std::string letters_and_digits(const std::string& text) {
    std::string out;
    for (const char c : folded(text))
        if (c != '-') out += c;
    return out;
}

}  // namespace

std::size_t edit_distance(const std::string& first, const std::string& second) {
    const std::string a = folded(first), b = folded(second);
    std::vector<std::size_t> before_last, last(b.size() + 1), now(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        now[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = std::min(now[j], before_last[j - 2] + 1);
        }
        before_last = last;
        last = now;
    }
    return last[b.size()];
}

std::string closest_name(const std::string& found, const std::vector<std::string>& valid) {
    constexpr std::size_t longest = 64;  // nobody mistypes more; and the distance takes length x length
    const std::string wanted = letters_and_digits(found);
    if (wanted.empty() || found.size() > longest) return {};
    std::string best;
    std::size_t least = std::max<std::size_t>(1, (wanted.size() + 1) / 3) + 1;
    for (const std::string& name : valid) {
        const std::size_t distance =
            std::min(edit_distance(found, name), edit_distance(wanted, letters_and_digits(name)));
        if (distance < least) {
            least = distance;
            best = name;
        }
    }
    if (!best.empty() || wanted.size() < 3) return best;
    for (const std::string& name : valid) {  // "cranley", "3070": the shortest name that contains it
        const bool contains = letters_and_digits(name).find(wanted) != std::string::npos;
        if (contains && (best.empty() || name.size() < best.size())) best = name;
    }
    if (!best.empty()) return best;
    for (const std::string& name : valid) {  // "GeForce RTX 3070": the longest name that is a part of it
        const std::string letters = letters_and_digits(name);
        if (letters.size() >= 3 && wanted.find(letters) != std::string::npos && name.size() > best.size()) best = name;
    }
    return best;
}

std::string did_you_mean(const std::string& found, const std::vector<std::string>& valid) {
    const std::string name = closest_name(found, valid);
    return name.empty() ? name : "; did you mean '" + name + "'?";
}

}  // namespace raycache
