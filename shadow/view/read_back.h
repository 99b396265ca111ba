// SPDX-License-Identifier: MIT
// From a finished graph to the CPU: samples, images, times.
#pragma once

#include "shadow/frame/frame.h"

namespace gn {

CpuSamples read_samples(FrameGraph& graph, const ViewSamples& samples);
/// R32F and RGBA32F textures as Image.
Image read_image(FrameGraph& graph, TextureHandle texture);
Image without_alpha(const Image& rgba);
Image with_alpha(const Image& rgb);  ///< 1 everywhere

/// Adds one run's times to the result; finish_times turns the passes into medians and copies the resources.
void record_times(const GraphStatistics& statistics, FrameResult& result);
void finish_times(const GraphStatistics& statistics, FrameResult& result);

/// V = 1 for every counted sample: the recipe `none`.
Visibility add_no_shadow(const FrameInput& input);
/// V = 1 on what receives no shadow, whatever a technique made of it; nothing where every object receives.
void add_unshadowed(const FrameInput& input, const Visibility& visibility);

}  // namespace gn
