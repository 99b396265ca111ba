// SPDX-License-Identifier: MIT
// Passes with their times and resources with their bytes: the one account of a plan.
#pragma once

#include "gpu/graph_plan.h"

namespace gn {

/// ms: per planned pass, or empty.
GraphStatistics account(const GraphDeclaration& declaration, const GraphPlan& plan, std::span<const double> ms);

}  // namespace gn
