// SPDX-License-Identifier: MIT
#include "base/paths.h"

#include "base/error.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <system_error>

namespace gn {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

bool holds_data(const fs::path& folder) {
    std::error_code ignored;
    return fs::is_directory(folder / "recipes", ignored) && fs::exists(folder / "base/shared.h", ignored);
}

fs::path find_data() {
    // Obey the user's variable, and only it, when it is set.
    if (const std::string named = variable("GNOMON_DATA"); !named.empty()) {
        if (!holds_data(named)) {
            fail(
                "GNOMON_DATA={} does not hold recipes/ and base/shared.h; it must be a gnomon data folder or source "
                "tree",
                named);
        }
        return fs::absolute(named);
    }

    // Prefer the installed or bundled folder beside the executable over the source tree.
    std::error_code none;
    const fs::path executable = fs::read_symlink("/proc/self/exe", none);
    fs::path installed = (executable.parent_path() / "../share/gnomon").lexically_normal();
    if (!none && holds_data(installed)) {
        return installed;
    }
    if (holds_data(GNOMON_SOURCE_DIR)) {
        return GNOMON_SOURCE_DIR;
    }
    fail("gnomon's data folder is neither {} nor {}; set GNOMON_DATA to the folder that holds recipes/ and base/",
         installed.string(), GNOMON_SOURCE_DIR);
}

bool writable(const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    return !failed && access(folder.c_str(), W_OK | X_OK) == 0;
}

fs::path find_cache() {
    const std::string named = variable("GNOMON_CACHE");
    const std::string xdg = variable("XDG_CACHE_HOME");
    const std::string home = variable("HOME");
    const fs::path candidate = !named.empty()  ? fs::path(named)
                               : !xdg.empty()  ? fs::path(xdg) / "gnomon"
                               : !home.empty() ? fs::path(home) / ".cache/gnomon"
                                               : fs::path();
    return !candidate.empty() && writable(candidate) ? fs::absolute(candidate) : fs::path();
}

}  // namespace

bool has_room(const fs::path& folder, std::uintmax_t bytes) {
    std::error_code code;
    fs::path there = fs::absolute(folder, code);
    while (!fs::is_directory(there, code) && there.has_relative_path()) {
        there = there.parent_path();
    }
    // The name is gone at once; the bytes are when the file is closed.
    std::string name = (there / ".gnomon-room-XXXXXX").string();
    const int file = mkstemp(name.data());
    if (file < 0) {
        return false;
    }
    unlink(name.c_str());
    const bool room = posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0;
    close(file);
    return room;
}

const fs::path& data_root() {
    static const fs::path root = find_data();
    return root;
}

const fs::path& cache_root() {
    static const fs::path root = find_cache();
    return root;
}

}  // namespace gn
