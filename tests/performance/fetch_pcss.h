// SPDX-License-Identifier: MIT
// The parameters of fetch_pcss.glsl are those of pcss.
#ifndef GN_TESTS_PERFORMANCE_FETCH_PCSS_H
#define GN_TESTS_PERFORMANCE_FETCH_PCSS_H

#include "shadow/lookup/pcss/pcss.h"

#endif
