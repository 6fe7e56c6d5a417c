// Errors a user can cause. Every message is one line that says what is wrong, where, what was expected, what was
// found, and what to do about it. Nothing else in the project reports bad input: no assert, no exit().
#pragma once

#include <stdexcept>

namespace raycache {

/// Bad data: a file, a value inside a file, a full disk. The program ends with exit code 1.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Bad use of the command line: an unknown name, a value out of range. The program ends with exit code 2.
struct UsageError : Error {
    using Error::Error;
};

}  // namespace raycache
