// SPDX-License-Identifier: MIT
// The blend at its ends is either shadow to the bit, and between both elsewhere.
#include "shadow/visibility/hybrid_frustum/hybrid_frustum.glsl"

#include "tests/rig.h"

namespace gn::hybrid_frustum_test {
namespace {

TEST(HybridFrustum, WeighsTheSoftShadowByThePenumbrasWidth) {
    const GnHybridFrustumParams params{.narrow = 2, .wide = 6};
    EXPECT_EQ(glsl::gn_hybrid_frustum_weight(1.9F, params), 0.0F);
    EXPECT_EQ(glsl::gn_hybrid_frustum_weight(4.0F, params), 0.5F);
    EXPECT_EQ(glsl::gn_hybrid_frustum_weight(6.1F, params), 1.0F);
}

std::vector<float> visibility(const std::string& recipe) {
    return test::compare("contact:radius=1", recipe, {.width = 96, .height = 72, .samples = 1}).visibility().values;
}

TEST(HybridFrustumRendered, IsEitherShadowAtItsEndsAndBetweenThemElsewhere) {
    const std::vector<float> hard = visibility("irregular-z,resolution=256");
    const std::vector<float> soft = visibility("pcss,resolution=256");
    EXPECT_EQ(visibility("hybrid-frustum,resolution=256,hybrid-frustum.by=hard"), hard);
    EXPECT_EQ(visibility("hybrid-frustum,resolution=256,hybrid-frustum.by=soft"), soft);
    const std::vector<float> blended =
        visibility("hybrid-frustum,resolution=256,hybrid-frustum.narrow=0.5,hybrid-frustum.wide=1.5");
    int hard_alone = 0;
    int soft_alone = 0;
    for (std::size_t i = 0; i < blended.size(); ++i) {
        EXPECT_GE(blended[i], std::min(hard[i], soft[i]) - 1e-6F) << i;
        EXPECT_LE(blended[i], std::max(hard[i], soft[i]) + 1e-6F) << i;
        hard_alone += hard[i] != soft[i] && blended[i] == hard[i] ? 1 : 0;
        soft_alone += hard[i] != soft[i] && blended[i] == soft[i] ? 1 : 0;
    }
    EXPECT_GT(hard_alone, 10);
    EXPECT_GT(soft_alone, 10);
}

}  // namespace
}  // namespace gn::hybrid_frustum_test
