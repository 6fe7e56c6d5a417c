// Files that are being written, under names that no other run has: "NAME.PID-RANDOM.partial", in the folder of the file
// that each becomes. A whole one takes the file's name; of a run that was killed, one stays behind.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace raycache::traces {

class PartialFile {
public:
    /// Creates the partial file of `path`, which no other process has open, with the permissions of the file of that
    /// name if there is one. Throws std::system_error: it cannot, or the file of that name is write-protected.
    explicit PartialFile(std::string path);
    ~PartialFile();  ///< closes and, unless it has its name, removes it
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    int descriptor() const { return descriptor_; }
    const std::string& name() const { return name_; }
    /// Brings all bytes to the disk and gives the file the name `path`: the file of that name, whoever wrote it, is
    /// replaced at once. Throws std::system_error; ESTALE where the partial file was removed or replaced.
    void publish();

private:
    std::string path_, name_;
    int descriptor_ = -1;
    bool published_ = false;
};

/// Partial files of `path` whose writers no longer live: nobody will finish them.
std::vector<std::string> abandoned_partial_files(const std::string& path);

/// Where the symbolic links of a file's name lead, also if there is no file yet.
std::string followed_links(std::string path);

/// Is told of every file that this process has finished: its name and its size in bytes. Set before any is written.
void on_published(std::function<void(const std::string& path, std::uint64_t bytes)>);

struct OutputsLeft {
    std::vector<std::string> finished;  ///< names of files that are whole
    std::vector<std::string> removed;   ///< those that were being written
};
/// For a process that is about to end: removes all partial files. Whoever publishes or creates one from now on waits
/// for ever.
OutputsLeft end_all_outputs();

}  // namespace raycache::traces
