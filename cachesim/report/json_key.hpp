// Keys of JSON: snake_case everywhere.
#pragma once

#include <string>
#include <string_view>

namespace raycache::cachesim {

/// A title as a key: "L1 port" -> "l1_port", "K from D*" -> "k_from_d_star", "N=16" -> "n_16".
inline std::string snake_case(std::string_view title) {
    std::string key;
    const auto gap = [&] {
        if (!key.empty() && key.back() != '_') key += '_';
    };
    for (const char c : title) {
        if (c >= 'A' && c <= 'Z')
            key += static_cast<char>(c - 'A' + 'a');
        else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
            key += c;
        else if (c == '*') {
            gap();
            key += "star";
        } else
            gap();
    }
    while (!key.empty() && key.back() == '_') key.pop_back();
    return key;
}

}  // namespace raycache::cachesim
