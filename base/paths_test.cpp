// SPDX-License-Identifier: MIT
#include "base/paths.h"

#include <gtest/gtest.h>

namespace gn::paths_test {
namespace {

TEST(Paths, RoomIsWhatCouldBeWritten) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    EXPECT_TRUE(has_room(folder, 4096));
    // A folder that is not there yet is judged by the one that it would be made in.
    EXPECT_TRUE(has_room(folder / "gnomon-no-such-folder/below", 4096));
    // No disk has an exbibyte, and nothing can be written into /proc.
    EXPECT_FALSE(has_room(folder, std::uintmax_t{1} << 60U));
    EXPECT_FALSE(has_room("/proc", 1));
}

}  // namespace
}  // namespace gn::paths_test
