// SPDX-License-Identifier: MIT
#include "shadow/shading/illuminance.h"

#include "shadow/shading/shading.glsl"

namespace gn {

std::vector<float> unshadowed_illuminance(const CpuSamples& samples, const GnLight& light) {
    std::vector<float> lux(samples.position_ws.size(), 0.0F);
    for (std::size_t i = 0; i < lux.size(); ++i) {
        const vec3 p_ws(samples.position_ws[i]);
        const vec3 n_ws(samples.normal_ws[i]);
        if (samples.position_ws[i].w > 0.5F && gn_counted(light, p_ws, n_ws)) {
            lux[i] = glsl::gn_illuminance(light, p_ws) * glm::dot(n_ws, gn_to_light(light, p_ws));
        }
    }
    return lux;
}

}  // namespace gn
