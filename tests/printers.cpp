// SPDX-License-Identifier: MIT
#include "tests/printers.h"

GN_PRINTERS()
