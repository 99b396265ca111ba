// SPDX-License-Identifier: MIT
// Devices that go without a feature: what is required and not enabled is named at once; without what may be missing every
// shipped recipe is served, to the same V, or refused with the feature's name.
#include "shadow/embed/host.h"
#include "shadow/recipe/check_recipe.h"
#include "tests/lent_renderer.h"
#include "tests/thorough.h"

namespace gn::embed::features_test {
namespace {

using test::device;

std::vector<Feature> features_of(const Device& of) {
    std::vector<Feature> present;
    for (int i = 0; i < feature_count; ++i) {
        if (of.has(static_cast<Feature>(i))) {
            present.push_back(static_cast<Feature>(i));
        }
    }
    return present;
}

/// Extensions that a feature stands on.
std::vector<std::string_view> extensions_of(Feature feature) {
    switch (feature) {
        case Feature::conservative_rasterization: return {VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME};
        case Feature::fragment_interlock: return {VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME};
        case Feature::atomic_float_add: return {VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME};
        case Feature::ray_query:
            return {VK_KHR_RAY_QUERY_EXTENSION_NAME, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
        default: return {};
    }
}

/// A device of the suite's instance, under its validation, that was made without some features.
class DeviceWithout {
  public:
    explicit DeviceWithout(std::span<const Feature> missing) {
        Candidate candidate = examine(device().physical());
        for (const Feature feature : missing) {
            candidate.features[static_cast<std::size_t>(feature)] = false;
            for (const std::string_view extension : extensions_of(feature)) {
                std::erase(candidate.extensions, extension);
            }
        }
        enable(candidate, chain_, extensions_);
        const float priority = 1;
        const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueFamilyIndex = device().queue_family(),
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority};
        const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &chain_.core,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = static_cast<std::uint32_t>(extensions_.size()),
                                      .ppEnabledExtensionNames = extensions_.data()};
        GN_VK(vkCreateDevice(device().physical(), &info, nullptr, &device_));
        vkGetDeviceQueue(device_, device().queue_family(), 0, &queue_);
    }
    DeviceWithout(const DeviceWithout&) = delete;
    DeviceWithout& operator=(const DeviceWithout&) = delete;
    ~DeviceWithout() { vkDestroyDevice(device_, nullptr); }

    [[nodiscard]] AdoptedDevice adopted() const {
        return {device().instance(),     device().physical(), device_,    queue_,
                device().queue_family(), &chain_.core,        extensions_};
    }

  private:
    FeatureChain chain_;
    std::vector<const char*> extensions_;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
};

/// A picture by a recipe: V of every light, and why lights have none.
FrameResult picture(host::Session& session, const std::string& recipe) {
    Result<FrameResult> rendered =
        session.render(session.scene()->cameras.front(), recipe, {.width = 48, .height = 32, .picture = false});
    EXPECT_TRUE(rendered.ok()) << recipe << ": " << rendered.why();
    return rendered.ok() ? std::move(rendered.value()) : FrameResult{};
}

host::Session session_on(const AdoptedDevice& adopted) {
    Result<host::Session> session = host::Session::adopt(adopted);
    EXPECT_TRUE(session.ok()) << session.why();
    EXPECT_TRUE(session.value().set_scene(load_scene("contact")).ok());
    return std::move(session.value());
}

/// What the suite's device, which has all that there is, makes of a recipe.
const FrameResult& with_all(const std::string& recipe) {
    static const test::LentDevice lent;
    static host::Session session = session_on(lent.adopted());
    static std::map<std::string, FrameResult> made;
    const auto found = made.find(recipe);
    return found != made.end() ? found->second : made.emplace(recipe, picture(session, recipe)).first->second;
}

bool names_one(const std::string& sentence, std::span<const Feature> features) {
    return std::any_of(features.begin(), features.end(),
                       [&](Feature feature) { return sentence.find(feature_name(feature)) != std::string::npos; });
}

/// Every recipe, or every `stride`-th from one on.
void expect_served_or_refused(std::span<const Feature> missing, std::size_t first = 0, std::size_t stride = 1) {
    const test::ValidationGuard guard;
    const DeviceWithout less(missing);
    host::Session session = session_on(less.adopted());
    const std::vector<std::string> recipes = recipe_names();
    for (std::size_t r = first; r < recipes.size(); r += stride) {
        const std::string recipe = test::with_small_maps(recipes[r], 256);
        const FrameResult& all = with_all(recipe);
        const FrameResult frame = picture(session, recipe);
        for (std::size_t light = 0; light < all.refused.size() && light < frame.refused.size(); ++light) {
            if (frame.refused[light] != all.refused[light]) {
                EXPECT_TRUE(names_one(frame.refused[light], missing)) << recipe << ": " << frame.refused[light];
            } else if (frame.refused[light].empty()) {
                EXPECT_EQ(frame.visibility[light].values.size(), all.visibility[light].values.size()) << recipe;
                double off = 0;
                for (std::size_t i = 0; i < all.visibility[light].values.size(); ++i) {
                    off += std::abs(frame.visibility[light].values[i] - all.visibility[light].values[i]);
                }
                // Filters at a slant may differ without anisotropy, on a pixel in fifty by all of V.
                EXPECT_LT(off, static_cast<double>(all.visibility[light].values.size()) / 50) << recipe;
            }
        }
    }
}

class WithoutFeature : public testing::TestWithParam<Feature> {};

/// Features of formats and limits need no enabling, and cannot be left out.
std::vector<Feature> features_that_are_enabled() {
    const test::LentDevice lent;
    std::vector<Feature> found;
    for (const Feature feature : features_of(device())) {
        FeatureChain chain;
        std::vector<const char*> extensions;
        Candidate candidate = examine(device().physical());
        candidate.features[static_cast<std::size_t>(feature)] = false;
        enable(candidate, chain, extensions);
        AdoptedDevice told = lent.adopted();
        told.features = &chain.core;
        std::erase_if(told.extensions, [&](std::string_view name) {
            const std::vector<std::string_view> own = extensions_of(feature);
            return std::find(own.begin(), own.end(), name) != own.end();
        });
        if (!Device::adopt(told)->has(feature)) {
            found.push_back(feature);
        }
    }
    return found;
}

TEST_P(WithoutFeature, EveryRecipeIsServedOrRefusedByItsName) {
    const std::vector<Feature> enabled = features_that_are_enabled();
    if (std::find(enabled.begin(), enabled.end(), GetParam()) != enabled.end()) {
        const std::array missing{GetParam()};
        // Each feature by itself with recipes in turn; the next test has every recipe without any of them.
        constexpr std::size_t turns = 6;
        const std::size_t stride = test::thorough() ? 1 : turns;
        expect_served_or_refused(missing, static_cast<std::size_t>(GetParam()) % stride, stride);
    }
}

std::vector<Feature> all_features() {
    std::vector<Feature> all;
    for (int i = 0; i < feature_count; ++i) {
        all.push_back(static_cast<Feature>(i));
    }
    return all;
}
INSTANTIATE_TEST_SUITE_P(Features, WithoutFeature, testing::ValuesIn(all_features()),
                         [](const auto& test) { return std::string(feature_name(test.param)); });

TEST(WithoutFeatures, AtOnceToo) {
    const std::vector<Feature> missing = features_that_are_enabled();
    EXPECT_GT(missing.size(), 3U);
    expect_served_or_refused(missing, 0, test::sanitized ? 4 : 1);
}

}  // namespace
}  // namespace gn::embed::features_test
