// SPDX-License-Identifier: MIT
#include "base/error.h"

#include <cstdio>
#include <cstdlib>

namespace gn {

void check_failed(const char* file, int line, const char* expression, const std::string& values) {
    std::fprintf(stderr, "gnomon: broken invariant at %s:%d: %s %s\n", file, line, expression, values.c_str());
    std::abort();
}

}  // namespace gn
