// SPDX-License-Identifier: MIT
// The gnomon command as a subprocess, and a folder to let it work in.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace gn {

struct CommandResult {
    int status = -1;  ///< exit status, or 128 + signal
    std::string out, err;
    long peak_kilobytes = 0;  ///< the most memory that it had resident
};

/// A folder of its own for a test, removed at the end.
class ScratchFolder {
  public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    void write(const std::string& name, const std::string& text) const;

  private:
    std::filesystem::path path_;
};

/// A started command; its output goes to files in a folder of its own.
class RunningCommand {
  public:
    explicit RunningCommand(const std::vector<std::string>& arguments);
    void signal(int number) const;
    [[nodiscard]] bool finished();
    /// What it has written on standard output so far.
    [[nodiscard]] std::string said() const;
    /// Waits; after `seconds` the command is killed and its status is 128 + SIGKILL.
    CommandResult wait(int seconds = 300);

  private:
    ScratchFolder folder_;
    pid_t pid_ = -1;
    int state_ = 0;
    long peak_kilobytes_ = 0;
    bool finished_ = false;
};

/// The gnomon that is tested: what GNOMON_EXECUTABLE names in the environment, or else the one of this build. So one build
/// of this suite tests the commands of all builds.
std::string gnomon_executable();

/// Runs the command with these arguments to its end.
CommandResult run_gnomon(const std::vector<std::string>& arguments);

/// Every part stands in the text; the failure prints both.
void expect_has(const std::string& text, const std::vector<std::string>& parts);

std::string file_text(const std::filesystem::path& path);

}  // namespace gn
