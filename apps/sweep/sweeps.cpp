// SPDX-License-Identifier: MIT
#include "apps/sweep/sweeps.h"

#include "apps/output.h"
#include "base/error.h"
#include "base/param.h"
#include "base/paths.h"
#include "gpu/hash.h"

#include <algorithm>

namespace gn {
namespace {

constexpr std::uintmax_t most_bytes = 4U << 20U;

std::vector<std::string> shipped() {
    std::vector<std::string> names;
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(data_root() / "sweeps", code)) {
        if (entry.path().extension() == ".toml") {
            names.push_back(entry.path().stem());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

NamedSweep find_sweep(const std::string& name_or_path, bool quick) {
    std::filesystem::path path = name_or_path;
    if (path.extension() != ".toml") {
        const std::vector<std::string> names = shipped();
        if (std::find(names.begin(), names.end(), name_or_path) == names.end()) {
            const std::vector<std::string_view> known(names.begin(), names.end());
            fail("no sweep is called '{}'; {}; or a path to a .toml file", name_or_path, suggest(name_or_path, known));
        }
        path = data_root() / "sweeps" / (name_or_path + ".toml");
    }
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code) || std::filesystem::file_size(path, code) > most_bytes) {
        fail("{}: is no file, or one of more than {} MiB", path.string(), most_bytes >> 20U);
    }
    return {{path.stem(), read_text(path), GNOMON_VERSION, quick}, path.string()};
}

std::string fingerprint_of(std::string_view text) {
    return Hasher().text(text).finish().hex().substr(0, 16);
}

}  // namespace gn
