// SPDX-License-Identifier: MIT
// The C header gives what the C++ one gives, and sentences for mistakes.
#include "shadow/embed/gnomon.h"

#include "tests/direct_scenes.h"
#include "tests/own_draws.h"

namespace gn::embed::gnomon_test {
namespace {

using test::device;

/// Copies what a call gave, since it stays only until the next.
std::string text(const char* why) {
    return why != nullptr ? why : "";
}

/// The suite's device as C lends it; the extensions' names stay with `adopted`.
GnomonInfo info_of(const AdoptedDevice& adopted, const char* recipe) {
    return {.size = sizeof(GnomonInfo),
            .instance = adopted.instance,
            .physical = adopted.physical,
            .device = adopted.device,
            .queue = adopted.queue,
            .queue_family = adopted.queue_family,
            .extension_count = static_cast<uint32_t>(adopted.extensions.size()),
            .extensions = adopted.extensions.data(),
            .features = adopted.features,
            .recipe = recipe,
            .width = 1920,
            .height = 1080,
            .lights = 8,
            .frames_in_flight = 2,
            .normals = GNOMON_NORMALS_SIGNED_XYZ,
            .reversed_depth = true};
}

GnomonImage image_of(const LentImage& lent) {
    return {lent.image, lent.format, lent.before, lent.after};
}

GnomonBuffer buffer_of(const LentBuffer& lent) {
    return {lent.buffer, lent.offset, lent.bytes};
}

void copy(const vec4& from, float (&to)[3]) {
    std::copy_n(&from.x, 3, to);
}

/// A frame of the C++ boundary as C writes it down.
struct FrameInC {
    std::vector<GnomonObject> objects;
    std::vector<GnomonLight> lights;
    std::vector<GnomonBox> moved;
    GnomonFrame frame{};

    explicit FrameInC(const Frame& from) {
        for (const CasterObject& o : from.casters.objects) {
            objects.push_back({o.first_index, o.index_count, o.first_vertex, o.vertex_count, o.single_sided});
        }
        for (const LentLight& lent : from.lights) {
            const GnLight& shape = lent.shape;
            GnomonLight light{.id = lent.id,
                              .kind = static_cast<GnomonLightKind>(shape.kind),
                              .half_size = {shape.half_size.x, shape.half_size.y},
                              .radius = shape.radius,
                              .angular_radius = shape.angular_radius,
                              .cos_inner = shape.cos_inner,
                              .cos_outer = shape.cos_outer,
                              .range = shape.range,
                              .visibility = image_of(lent.visibility)};
            copy(shape.position_ws, light.position_ws);
            copy(shape.direction_ws, light.direction_ws);
            copy(shape.right_ws, light.right_ws);
            copy(shape.up_ws, light.up_ws);
            lights.push_back(light);
        }
        for (const Box& box : from.casters.moved_ws.value_or(std::span<const Box>())) {
            moved.emplace_back();
            copy(vec4(box.min, 0), moved.back().min_ws);
            copy(vec4(box.max, 0), moved.back().max_ws);
        }
        frame = {.size = sizeof(GnomonFrame),
                 .object_size = sizeof(GnomonObject),
                 .light_size = sizeof(GnomonLight),
                 .slot = from.slot,
                 .cut = from.cut,
                 .width = from.receivers.width,
                 .height = from.receivers.height,
                 .depth = image_of(from.receivers.depth),
                 .normals = image_of(from.receivers.normals),
                 .positions = buffer_of(from.casters.positions),
                 .indices = buffer_of(from.casters.indices),
                 .transforms = buffer_of(from.casters.transforms),
                 .stride = from.casters.stride,
                 .object_count = static_cast<uint32_t>(objects.size()),
                 .light_count = static_cast<uint32_t>(lights.size()),
                 .objects = objects.data(),
                 .lights = lights.data(),
                 .topology = from.casters.topology,
                 .poses = from.casters.poses,
                 .moved = from.casters.moved_ws ? moved.data() : nullptr,
                 .moved_count = static_cast<uint32_t>(moved.size())};
        std::copy_n(&from.receivers.cs_from_ws[0].x, 16, frame.cs_from_ws);
        copy(vec4(from.casters.bounds_ws.min, 0), frame.bounds_min_ws);
        copy(vec4(from.casters.bounds_ws.max, 0), frame.bounds_max_ws);
    }
};

struct Destroy {
    void operator()(GnomonShadows* shadows) const { gnomon_destroy(shadows); }
};

std::unique_ptr<GnomonShadows, Destroy> create(const char* recipe) {
    const test::LentDevice lent;
    const AdoptedDevice adopted = lent.adopted();
    const GnomonInfo info = info_of(adopted, recipe);
    GnomonShadows* shadows = nullptr;
    EXPECT_EQ(text(gnomon_create(&info, &shadows)), "");
    return std::unique_ptr<GnomonShadows, Destroy>(shadows);
}

std::string record(GnomonShadows* shadows, const GnomonFrame& frame, const char** refused) {
    std::string why;
    device().run([&](VkCommandBuffer commands) { why = text(gnomon_record(shadows, commands, &frame, refused)); });
    return why;
}

TEST(GnomonC, GivesTheImagesOfTheBoundary) {
    const test::ValidationGuard guard;
    const char* recipe = "pcf,placement=cascades";
    test::LentRenderer renderer(by_hand::lit_garden(), 160, 90);
    const Frame frame = renderer.frame();
    const test::LentDevice lent;
    Result<Shadows> direct = Shadows::create({.device = lent.adopted(), .recipe = recipe});
    ASSERT_TRUE(direct.ok()) << direct.why();
    device().run([&](VkCommandBuffer commands) { EXPECT_TRUE(direct.value().record(commands, frame).ok()); });
    std::vector<std::vector<float>> expected;
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        expected.push_back(renderer.visibility(i));
        EXPECT_GT(*std::max_element(expected[i].begin(), expected[i].end()), 0.5F) << i;
    }

    // Through C into the same images, which begin as something else.
    const auto shadows = create(recipe);
    ASSERT_NE(shadows, nullptr);
    const FrameInC in_c(renderer.frame());
    std::vector<const char*> refused(in_c.lights.size(), "not asked");
    EXPECT_EQ(record(shadows.get(), in_c.frame, refused.data()), "");
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(text(refused[i]), "") << i;
        EXPECT_EQ(renderer.visibility(i), expected[i]) << i;
    }
    EXPECT_EQ(record(shadows.get(), FrameInC(renderer.frame()).frame, nullptr), "");

    // The slot's passes are told when it is taken up again.
    const GnomonPass* passes = nullptr;
    ASSERT_GT(gnomon_completed(shadows.get(), 0, &passes), 5U);
    EXPECT_NE(text(passes[0].name), "");
    EXPECT_GT(gnomon_counters(shadows.get()).pipelines, 0U);
}

/// OwnDraws behind a pointer.
void draw(void* user, const GnomonCasterView* view) {
    CasterView cpp{.commands = view->commands, .light_id = view->light_id, .writes_depth = view->writes_depth};
    std::copy_n(view->cs_from_ws, 16, &cpp.view.cs_from_ws[0].x);
    std::copy_n(view->depth_from_ws, 4, &cpp.view.depth_from_ws.x);
    cpp.view.grid = view->grid;
    (*static_cast<test::OwnDraws*>(user))(cpp);
}

TEST(GnomonC, DrawsOfARenderersOwnGiveTheSame) {
    const test::ValidationGuard guard;
    const char* recipe = "hard,resolution=256,placement=cascades,cascades.scroll=1";
    test::LentRenderer renderer(by_hand::lit_garden(), 96, 54);
    const auto by_buffers = create(recipe), by_draws = create(recipe);
    ASSERT_TRUE(by_buffers != nullptr && by_draws != nullptr);
    EXPECT_EQ(record(by_buffers.get(), FrameInC(renderer.frame()).frame, nullptr), "");
    std::vector<std::vector<float>> expected;
    for (std::size_t i = 0; i < renderer.scene.lights.size(); ++i) {
        expected.push_back(renderer.visibility(i));
    }
    test::OwnDraws draws(renderer);
    FrameInC in_c(renderer.frame());
    in_c.frame.positions = in_c.frame.indices = in_c.frame.transforms = {};
    in_c.frame.object_count = 0;
    in_c.frame.draw = draw;
    in_c.frame.draw_user = &draws;
    GnomonForeseen foreseen{.size = sizeof(GnomonForeseen)};
    EXPECT_EQ(text(gnomon_foresee(by_draws.get(), &in_c.frame, &foreseen, nullptr)), "");
    EXPECT_EQ(foreseen.depth, VK_FORMAT_D32_SFLOAT);
    EXPECT_TRUE(foreseen.affine && foreseen.bent);
    EXPECT_GT(foreseen.pass_count, 5U);
    EXPECT_GT(foreseen.transient_bytes, 0U);
    EXPECT_EQ(record(by_draws.get(), in_c.frame, nullptr), "");
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(renderer.visibility(i), expected[i]) << i;
    }
    foreseen.size = 1;
    EXPECT_NE(text(gnomon_foresee(by_draws.get(), &in_c.frame, &foreseen, nullptr)).find("GnomonForeseen"),
              std::string::npos);
}

TEST(GnomonC, MistakesAreSentences) {
    const test::LentDevice lent;
    const AdoptedDevice adopted = lent.adopted();
    GnomonShadows* none = nullptr;
    EXPECT_NE(text(gnomon_create(nullptr, &none)).find("info"), std::string::npos);
    GnomonInfo info = info_of(adopted, "pfc");
    EXPECT_NE(text(gnomon_create(&info, nullptr)), "");
    EXPECT_NE(text(gnomon_create(&info, &none)).find("'pfc'"), std::string::npos);
    info.recipe = nullptr;
    EXPECT_NE(text(gnomon_create(&info, &none)).find("recipe"), std::string::npos);
    info.recipe = "hard";
    info.baked = "/dev/null";
    EXPECT_NE(text(gnomon_create(&info, &none)).find("/dev/null: there is no manifest.txt"), std::string::npos);
    info.baked = nullptr;
    info.extensions = nullptr;
    EXPECT_NE(text(gnomon_create(&info, &none)).find("extensions"), std::string::npos);
    info.size = 8;
    EXPECT_NE(text(gnomon_create(&info, &none)).find("gnomon.h"), std::string::npos);
    EXPECT_EQ(none, nullptr);

    test::LentRenderer renderer(load_scene("contact"), 96, 64);
    const auto shadows = create("hard,placement=paraboloid");
    ASSERT_NE(shadows, nullptr);
    FrameInC in_c(renderer.frame());
    EXPECT_NE(text(gnomon_refuses(shadows.get(), in_c.lights.data())).find("paraboloid"), std::string::npos);
    const char* refused = nullptr;
    EXPECT_EQ(record(shadows.get(), in_c.frame, &refused), "");
    EXPECT_NE(text(refused).find("paraboloid"), std::string::npos);
    EXPECT_NE(text(gnomon_set_recipe(shadows.get(), "volumes")).find("'volumes'"), std::string::npos);
    EXPECT_EQ(text(gnomon_set_recipe(shadows.get(), "hard")), "");
    EXPECT_EQ(text(gnomon_refuses(shadows.get(), in_c.lights.data())), "");
    bool awaited = true;
    EXPECT_EQ(text(gnomon_preparation(shadows.get(), &awaited)), "");
    EXPECT_FALSE(awaited);
    EXPECT_NE(text(gnomon_prepare_recipe(shadows.get(), "volumes")).find("'volumes'"), std::string::npos);
    EXPECT_EQ(text(gnomon_prepare_recipe(shadows.get(), "pcf")), "");
    EXPECT_EQ(text(gnomon_preparation(shadows.get(), &awaited)), "");
    EXPECT_TRUE(awaited);
    std::size_t changed = 1;
    EXPECT_EQ(text(gnomon_reload(shadows.get(), &changed)), "");
    EXPECT_EQ(changed, 0U);
    EXPECT_NE(text(gnomon_reload(nullptr, nullptr)), "");
    in_c.frame.objects = nullptr;
    EXPECT_NE(record(shadows.get(), in_c.frame, nullptr).find("objects"), std::string::npos);
    in_c.frame.light_size = 1;
    EXPECT_NE(record(shadows.get(), in_c.frame, nullptr).find("GnomonLight"), std::string::npos);
}

}  // namespace
}  // namespace gn::embed::gnomon_test
