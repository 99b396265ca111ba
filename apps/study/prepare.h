// SPDX-License-Identifier: MIT
// A study's folder: its plan, and a survey's pictures, drawn as `gnomon compare` draws them.
#pragma once

#include "apps/options.h"

namespace gn {

/// Writes DIR/study.json last: a folder that has it is whole. What has it already is left alone. Returns the exit status.
int prepare_study(const StudyOptions& options);

}  // namespace gn
