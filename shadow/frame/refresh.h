// SPDX-License-Identifier: MIT
// What moved, brought to the GPU within a frame's own commands: nothing waits, and once the arena has its size nothing is made.
#pragma once

#include "gpu/upload_arena.h"
#include "shadow/stages.h"

namespace gn {

/// As refresh_scene, recorded before the frame that is to show it. `staging`: whose bytes live until these commands have
/// completed; the caller resets it then.
void record_refresh(VkCommandBuffer commands, SceneGpu& scene, UploadArena& staging);

}  // namespace gn
