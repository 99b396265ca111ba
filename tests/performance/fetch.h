// SPDX-License-Identifier: MIT
// The parameters of the lookups that only fetch are those of pcf.
#include "shadow/lookup/pcf/pcf.h"
