// A text file that gets its name only when it is whole, compressed by xz if the name ends in ".xz".
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace raycache::traces {

class XzFile {
public:
    explicit XzFile(const std::string& path);  ///< throws Error as OutputFile does, and so do the others
    ~XzFile();                                 ///< removes the partial file unless commit() was reached
    XzFile(const XzFile&) = delete;
    XzFile& operator=(const XzFile&) = delete;

    void write(std::string_view);
    void commit();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::traces
