// SPDX-License-Identifier: MIT
// The study behind a socket.
#pragma once

#include "apps/options.h"

namespace gn {

/// Serves until SIGINT or SIGTERM. Prints the participants' address and the administrator's. Returns the exit status.
int serve_study(const StudyOptions& options);

}  // namespace gn
