// SPDX-License-Identifier: MIT
// What a failed expectation prints of plain types is compiled once a suite, in printers.cpp, and not in every test: it was a
// tenth of what tests compile to.
#pragma once

#include <gtest/gtest.h>

#include <string>

// clang-format off
#define GN_PRINTED(extern_, type) extern_ template std::string testing::PrintToString<type>(type const&);
#define GN_ORDERED(extern_, type)                                                                          \
    extern_ template testing::AssertionResult testing::internal::CmpHelperOpFailure<type, type>(           \
        const char*, const char*, type const&, type const&, const char*);
#define GN_PRINTERS(extern_)                                                                               \
    GN_PRINTED(extern_, int) GN_PRINTED(extern_, long) GN_PRINTED(extern_, unsigned int)                   \
    GN_PRINTED(extern_, unsigned long) GN_PRINTED(extern_, float) GN_PRINTED(extern_, double)              \
    GN_PRINTED(extern_, bool) GN_PRINTED(extern_, std::string) GN_PRINTED(extern_, const char*)            \
    GN_ORDERED(extern_, int) GN_ORDERED(extern_, unsigned int) GN_ORDERED(extern_, unsigned long)          \
    GN_ORDERED(extern_, float) GN_ORDERED(extern_, double)
// clang-format on

GN_PRINTERS(extern)
