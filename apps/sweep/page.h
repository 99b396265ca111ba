// SPDX-License-Identifier: MIT
// A sweep as a page of curves, and as a table for other programs.
#pragma once

#include "apps/evaluation/sweep_store.h"

#include <filesystem>

namespace gn {

/// Throws InputError where DIR cannot be made or written to.
void check_sweep_page(const std::filesystem::path& folder);

/// Writes DIR/index.html, complete in itself, and DIR/runs.csv: a line a run, its place on every axis and every figure.
/// Throws Error.
void write_sweep_page(const std::filesystem::path& folder, SweepStore& store);

}  // namespace gn
