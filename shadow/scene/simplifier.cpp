// SPDX-License-Identifier: MIT
#include "shadow/scene/simplifier.h"

namespace gn {

Simplifier& simplifier() {
    static Simplifier registered = nullptr;
    return registered;
}

}  // namespace gn
